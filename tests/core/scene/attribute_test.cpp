// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/error.h"
#include "core/scene/gaussian_sequence.h"

namespace beam {
namespace {

using ::testing::HasSubstr;

GaussianFrame twoGaussians() {
  GaussianFrame f;
  f.cloud.position_m = {vec3(0), vec3(1)};
  f.cloud.rotation.assign(2, quat(1, 0, 0, 0));
  f.cloud.scale_m.assign(2, vec3(0.1f));
  f.cloud.opacity = {0.25f, 0.5f};
  f.cloud.color = ShBlock(2, 3);
  f.materials = Materials{{0.3f, 0.6f}, ShBlock(2, 3), ShBlock(2, 1)};
  return f;
}

std::string complaint(const GaussianFrame& f) {
  try {
    validate(f);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Data);
    return e.what();
  }
  return "";
}

TEST(Attributes, ListTheTypedOnesAndTheFramesOwnInTheirPlaces) {
  GaussianFrame f = twoGaussians();
  f.attributes.push_back({{.name = "metallic"}, {0.1f, 0.9f}});
  std::vector<std::string> names;
  for (const AttributeSpan& a : attributesOf(f)) {
    names.push_back(a.info.name);
    EXPECT_EQ(a.values.size(), 2u * a.info.channels * a.info.coefficients) << a.info.name;
  }
  EXPECT_THAT(names, ::testing::ElementsAre("opacity", "radiance", "roughness", "base_color",
                                            "ambient_occlusion", "metallic"));
  EXPECT_EQ(attributesOf(f)[2].values.data(), f.materials->roughness.data()) << "no copies";
  f.materials.reset();
  EXPECT_EQ(attributesOf(f).size(), 3u);
}

TEST(Attributes, TellWhichOfThemTurnAndInWhatStateTheirColourIs) {
  const GaussianFrame f = twoGaussians();
  for (const AttributeSpan& a : attributesOf(f)) {
    const bool sh =
        a.info.name == "radiance" || a.info.name == "base_color" || a.info.name == "ambient_occlusion";
    EXPECT_EQ(a.info.turns(), sh) << a.info.name;
    const Encoding expected = a.info.name == "radiance"     ? Encoding::Srgb
                              : a.info.name == "base_color" ? Encoding::Linear
                                                            : Encoding::Data;
    EXPECT_EQ(a.info.encoding, expected) << a.info.name;
  }
}

TEST(Attributes, ThatDoNotFitAreNamed) {
  const auto with = [](Attribute a) {
    GaussianFrame f = twoGaussians();
    f.attributes.push_back(std::move(a));
    return complaint(f);
  };
  EXPECT_EQ(with({{.name = "metallic"}, {0, 1}}), "");
  EXPECT_THAT(with({{.name = "metallic"}, {0, 1, 2}}),
              HasSubstr("expected 2 values of 2 Gaussians, found 3"));
  EXPECT_THAT(with({{.name = "flow", .channels = 2}, {0, 1, 2, 3}}), HasSubstr("found 2"));
  EXPECT_THAT(with({{.name = "glow", .coefficients = 4}, std::vector<float>(8)}), HasSubstr("found 4"));
  EXPECT_THAT(with({{.name = "roughness"}, {0, 1}}), HasSubstr("\"roughness\""));
  EXPECT_THAT(with({{.name = "glow"}, {0, std::numeric_limits<float>::quiet_NaN()}}),
              HasSubstr("Gaussian 1"));
  GaussianFrame twice = twoGaussians();
  twice.attributes.assign(2, {{.name = "metallic"}, {0, 1}});
  EXPECT_THAT(complaint(twice), HasSubstr("twice"));
}

TEST(FrameLabels, TakeTheLastRunOfDigitsForTheNumber) {
  EXPECT_EQ(frameNumber("frame_0012"), 12);
  EXPECT_EQ(frameNumber("cam2_007.raw"), 7);
  EXPECT_EQ(frameNumber("final"), -1);
  const auto labels = labelled({"a1", "b"});
  EXPECT_EQ(labels, (std::vector<FrameLabel>{{"a1", 1}, {"b", -1}}));
}

}  // namespace
}  // namespace beam
