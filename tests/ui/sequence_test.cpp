// SPDX-License-Identifier: Apache-2.0
// The window's model over frames that no project made: what an imported file of splats will be.
#include <gtest/gtest.h>

#include <QCoreApplication>

#include <memory>
#include <mutex>

#include "core/render/device.h"
#include "tests/support/splat_shapes.h"
#include "tests/support/wait_for.h"
#include "ui/joint_source.h"
#include "ui/player.h"
#include "ui/project_model.h"

namespace beam::testing {
namespace {

GaussianCloud ballAt(int frame) {
  GaussianCloud cloud;
  addSphere(cloud, vec3(0.1f * static_cast<float>(frame), 0, 0), 0.3f, 50);
  return cloud;
}

// Three frames, the middle one empty.
class ThreeBalls final : public GaussianSequence {
 public:
  std::string id() const override { return "balls.spz"; }
  const std::vector<FrameLabel>& frames() const override { return labels_; }
  double rate() const override { return 12; }
  std::optional<Digest> stamp(FrameIndex frame) const override {
    return frame.value == 1 ? Digest{} : Digest{7, static_cast<std::uint64_t>(frame.value)};
  }
  FrameContent content(FrameIndex frame) const override {
    return {.gaussians = frame.value != 1, .mesh = frame.value == 2};
  }
  std::shared_ptr<const GaussianFrame> load(FrameIndex frame) const override {
    if (frame.value == 1) return nullptr;
    auto made = std::make_shared<GaussianFrame>();
    made->cloud = ballAt(frame.value);
    return made;
  }
  std::shared_ptr<const Mesh> mesh(FrameIndex frame) const override {
    return frame.value == 2 ? std::make_shared<const Mesh>(Mesh{{vec3(0), vec3(1), vec3(2)}, {{0, 1, 2}}})
                            : nullptr;
  }

 private:
  std::vector<FrameLabel> labels_ = labelled({"walk_08", "walk_09", "walk_10"});
};

class SequenceInTheModel : public ::testing::Test {
 protected:
  void settle() {
    ASSERT_TRUE(waitFor([&] { return model.settled(); }));
  }
  ProjectModel model{StudioServices{}};
};

TEST_F(SequenceInTheModel, ShowsFramesNamesAndRateWithoutAProject) {
  Player player(model, [] { return true; });
  int told = 0;
  QObject::connect(&model, &ProjectModel::sequenceChanged, [&] { ++told; });
  model.show(std::make_shared<const ThreeBalls>());
  settle();
  EXPECT_EQ(told, 1);
  EXPECT_FALSE(model.isOpen());
  EXPECT_EQ(model.capture(), nullptr);
  EXPECT_EQ(model.frameCount(), 3);
  EXPECT_EQ(model.frameName(), "walk_08");
  EXPECT_EQ(player.clock().frames(), 3);
  EXPECT_EQ(player.clock().takeRate(), 12);
  ASSERT_TRUE(model.values().cloud);
  EXPECT_EQ(model.values().cloud->position_m, ballAt(0).position_m);
}

TEST_F(SequenceInTheModel, GoesToOtherFramesAndHoldsTheNearestWhereThereIsNone) {
  model.show(std::make_shared<const ThreeBalls>());
  model.setFrame(FrameIndex{2});
  settle();
  EXPECT_EQ(model.values().cloud->position_m, ballAt(2).position_m);
  ASSERT_TRUE(model.values().mesh);
  EXPECT_EQ(model.values().mesh->triangles.size(), 1u);
  model.setFrame(FrameIndex{1});
  settle();
  EXPECT_FALSE(model.values().cloud);
  ASSERT_TRUE(model.held());
  EXPECT_EQ(model.nameOf(model.held()->from), "walk_08") << "the earlier of two that are as near";
}

TEST_F(SequenceInTheModel, HasNoJointsAndSaysNothingOfARun) {
  model.show(std::make_shared<const ThreeBalls>());
  settle();
  JointSource joints(model);
  joints.refresh();
  ASSERT_TRUE(waitFor([&] { return joints.settled(); }));
  EXPECT_TRUE(joints.shown().trails.empty());
  EXPECT_TRUE(joints.shown().hint.isEmpty());
}

TEST_F(SequenceInTheModel, PrefetchesWithinTheCacheAndForgetsWhenClosed) {
  const auto sequence = std::make_shared<const ThreeBalls>();
  model.show(sequence);
  model.prefetch({FrameIndex{2}});
  ASSERT_TRUE(waitFor([&] { return model.cache().held(*sequence) == std::vector<bool>{true, false, true}; }));
  model.close();
  EXPECT_EQ(model.sequence(), nullptr);
  EXPECT_EQ(model.frameCount(), 0);
  EXPECT_FALSE(model.values().cloud);
  EXPECT_EQ(model.cache().bytes(), 0u);
}

}  // namespace
}  // namespace beam::testing
