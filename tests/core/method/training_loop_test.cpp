// SPDX-License-Identifier: Apache-2.0
// Laws of the one training loop: who is asked when, how steps are counted, when the 3D filter is renewed.
#include "core/method/training_loop.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam {
namespace {

const testing::SphereCapture kSphere{.cameras = 3, .size_px = 16};

GaussianCloud ball() {
  GaussianCloud cloud;
  testing::addSphere(cloud, kSphere.center, 0.25f, 20);
  return cloud;
}

TrainingLoop loopOf(double filter) {
  static const std::unique_ptr<ComputeDevice> kDevice = makeCpuDevice();
  return TrainingLoop(testing::photographs(kSphere), {}, false, ball(), filter, *kDevice);
}

// Writes down what it is asked; moves nothing of its own.
struct Witness : TrainingRule {
  std::string calls;
  std::vector<int> indices, adam;
  bool seen = false;  // a gradient that is not zero
  LearningRates rates{0, 0, 0, 0, 0, 0};

  void place(GaussianModel& /*model*/) override { calls += "p"; }
  ModelStep learn(TrainingStep step, const GaussianBuffers& gradients, TrainingOps& /*ops*/) override {
    calls += "l";
    indices.push_back(step.index);
    adam.push_back(step.adam);
    for (const float g : gradients.values) seen = seen || g != 0;
    return {rates, {}};
  }
  void finish(GaussianModel& /*model*/, TrainingStep /*step*/) override { calls += "f"; }
};

TEST(TrainingLoop, PlacesLearnsAndFinishesEveryStepAndCountsMomentsFromOne) {
  TrainingLoop loop = loopOf(0);
  Witness w;
  Progress progress;
  loop.run({.begin = 7, .end = 10}, w, progress);
  EXPECT_EQ(w.calls, "plfplfplf");
  EXPECT_EQ(w.indices, (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(w.adam, (std::vector<int>{1, 2, 3}));
  EXPECT_TRUE(w.seen);
}

TEST(TrainingLoop, LeavesTheGaussiansAsTheyAreWhenNothingMayLearn) {
  TrainingLoop loop = loopOf(0);
  const GaussianBuffers before = toBuffers(loop.model().cloud());
  Witness w;
  Progress progress;
  loop.run({.end = 4}, w, progress);
  EXPECT_EQ(before.values, toBuffers(loop.model().cloud()).values);
  w.rates.color_dc = 0.01f;
  loop.run({.end = 1}, w, progress);
  EXPECT_NE(before.values, toBuffers(loop.model().cloud()).values);
}

// Gaussians that go away from the cameras' middle, step by step: sizes follow only when the filter is
// renewed.
struct Leaving : Witness {
  std::vector<int> renewed;
  float size = 0;
  void place(GaussianModel& model) override {
    Pose pose = poseOf(ball());
    for (vec3& x : pose.position_m) x.x += 1e-3f * static_cast<float>(++step);
    model.place(pose);
  }
  void finish(GaussianModel& model, TrainingStep at) override {
    model.activate();
    const float now = model.physical().plane(PlaneLayout::kScale)[0];
    if (now != size) renewed.push_back(at.index);
    size = now;
  }
  int step = 0;
};

TEST(TrainingLoop, RenewsTheFilterAtItsBeginningAndAtEveryHundredthStep) {
  for (const auto& [from, expected] : {std::pair{0, std::vector{130, 200}}, {130, {130, 230}}}) {
    TrainingLoop loop = loopOf(2);
    Leaving rule;
    Progress progress;
    loop.run({.begin = 130, .end = 240, .filter_from = from}, rule, progress);
    EXPECT_EQ(rule.renewed, expected) << "counted from " << from;
  }
}

TEST(TrainingLoop, StopsWhenAskedTo) {
  TrainingLoop loop = loopOf(0);
  Witness w;
  std::stop_source stop;
  Progress progress(stop.get_token());
  stop.request_stop();
  EXPECT_THROW(loop.run({.end = 100}, w, progress), Cancelled);
  EXPECT_EQ(w.calls, "");
}

TEST(HalfOf, TheHalvesMeetAndCoverAllSteps) {
  for (const double share : {0.0, 0.4, 5.0 / 12, 1.0}) {
    const TrainingSpan first = halfOf(101, share, false), second = halfOf(101, share, true);
    EXPECT_EQ(first.begin, 0);
    EXPECT_EQ(first.end, second.begin);
    EXPECT_EQ(second.end, 101);
    EXPECT_NEAR(second.end - second.begin, 101 * share, 0.5);
  }
}

}  // namespace
}  // namespace beam
