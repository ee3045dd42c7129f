// SPDX-License-Identifier: Apache-2.0
#include "core/scene/channel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/message_of.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

RenderInstance something() {
  RenderInstance instance;
  instance.cloud = std::make_shared<const GaussianCloud>();
  instance.attributes = std::make_shared<const std::vector<Attribute>>();
  return instance;
}

TEST(Channels, HaveTheNamesThatFilesHave) {
  EXPECT_THAT(channelIds(), IsSupersetOf({"rgb", "relight", "base_color", "ao", "roughness", "normal",
                                          "depth", "alpha", "mesh"}));
  for (const std::string& id : channelIds()) EXPECT_EQ(channelOf(id).id, id);
  EXPECT_EQ(findChannel("colour"), nullptr);
  EXPECT_THAT(messageOf(Error::Kind::Usage, [] { channelOf("lit"); }),
              HasSubstr("expected some of rgb, relight"));
}

TEST(Channels, HaveOneKeyEachInTheWindow) {
  std::set<int> keys;
  for (const ChannelInfo& c : shownChannels()) EXPECT_TRUE(keys.insert(c.key).second) << c.id;
  ASSERT_EQ(shownChannels().front().id, kRelightChannel);
  EXPECT_EQ(*keys.begin(), 1);
  EXPECT_EQ(*keys.rbegin(), static_cast<int>(keys.size())) << "a digit without a channel";
}

TEST(Channels, SayWhatASceneLacks) {
  RenderScene scene;
  EXPECT_EQ(lackOf(channelOf("rgb"), scene), Lack::None);
  EXPECT_EQ(lackOf(channelOf("ao"), scene), Lack::Materials) << "nothing has none";
  scene.instances = {something(), something()};
  scene.instances[0].materials = std::make_shared<const Materials>();
  EXPECT_EQ(lackOf(channelOf("relight"), scene), Lack::Materials) << "one of two";
  scene.instances[1].materials = scene.instances[0].materials;
  EXPECT_EQ(lackOf(channelOf("ao"), scene), Lack::None);
  EXPECT_EQ(lackOf(channelOf("relight"), scene), Lack::Light);
  scene.environment = std::make_shared<const Environment>();
  EXPECT_EQ(lackOf(channelOf("relight"), scene), Lack::None);
  scene.lighting.environment.enabled = false;
  EXPECT_EQ(lackOf(channelOf("relight"), scene), Lack::Light);
}

TEST(Channels, MeshesAndTheGroundHaveMaterialsAndNoAttributes) {
  ChannelInfo speed;
  speed.attribute = "speed";
  RenderScene scene;
  scene.ground.enabled = true;
  EXPECT_EQ(lackOf(channelOf("base_color"), scene), Lack::None);
  EXPECT_EQ(lackOf(channelOf("relight"), scene), Lack::Light);
  EXPECT_EQ(lackOf(speed, scene), Lack::Attribute);
  scene.instances = {something()};
  EXPECT_EQ(lackOf(channelOf("base_color"), scene), Lack::Materials) << "of the Gaussians beside it";
}

TEST(Channels, AnAttributeIsThereWhenAllInstancesHaveIt) {
  ChannelInfo speed;
  speed.attribute = "speed";
  Attribute attribute;
  attribute.info.name = "speed";
  RenderScene scene;
  scene.instances = {something(), something()};
  scene.instances[0].attributes = std::make_shared<const std::vector<Attribute>>(1, attribute);
  EXPECT_EQ(lackOf(speed, scene), Lack::Attribute);
  scene.instances[1].attributes = scene.instances[0].attributes;
  EXPECT_EQ(lackOf(speed, scene), Lack::None);
}

}  // namespace
}  // namespace beam::testing
