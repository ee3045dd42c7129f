// SPDX-License-Identifier: Apache-2.0
// Joints follow a textured sphere that moves by several times their spacing; they repeat to the bit and stop
// when asked.
#include "core/method/track_joints.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/method/seed_points.h"
#include "core/optim/pose_model.h"
#include "tests/support/sphere_capture.h"

namespace beam {
namespace {

using testing::SphereCapture;

// All frames are seen by the cameras of the first.
std::vector<FrameView> photographsAt(const SphereCapture& first, vec3 center) {
  std::vector<FrameView> views = testing::photographs(first);
  SphereCapture moved = first;
  moved.center = center;
  for (FrameView& v : views) v = testing::photographSphere(moved, v.camera, v.name);
  return views;
}

TrackJointsOptions quick() {
  TrackJointsOptions o;
  o.joints = 400;
  o.first_iterations = 300;
  o.iterations = 240;
  o.levels = 3;
  return o;
}

GaussianCloud firstJoints(const std::vector<FrameView>& views, const TrackJointsOptions& o) {
  Progress progress;
  PointCloud seeds;
  {
    Progress part = progress.part(0.1, "seeds");
    seeds = seedPoints(views, {}, o.joints, o.seed, part);
  }
  Progress part = progress.part(0.9, "joints");
  return fitFirstJoints(views, seeds, o, *makeCpuDevice(), part);
}

float medianError(const GaussianCloud& from, const GaussianCloud& to, vec3 motion) {
  std::vector<float> error;
  for (std::size_t i = 0; i < from.size(); ++i)
    error.push_back(glm::length(to.position_m[i] - from.position_m[i] - motion));
  std::nth_element(error.begin(), error.begin() + error.size() / 2, error.end());
  return error[error.size() / 2];
}

TEST(TrackJoints, FollowsAMotionOfSeveralSpacings) {
  const SphereCapture s{.cameras = 12};
  const vec3 motion(0.16f, 0.05f, -0.1f);
  const TrackJointsOptions o = quick();
  const GaussianCloud first = firstJoints(photographsAt(s, s.center), o);
  ASSERT_GT(glm::length(motion), 3 * spacingOf(first.position_m));
  Progress progress;
  const TrackedJoints t = trackJoints(photographsAt(s, s.center + motion), {poseOf(first), first, {}}, o,
                                      *makeCpuDevice(), progress);
  ASSERT_EQ(t.joints.size(), first.size());
  EXPECT_EQ(t.joints.scale_m, first.scale_m);
  EXPECT_EQ(t.joints.opacity, first.opacity);
  EXPECT_LT(medianError(first, t.joints, motion), 0.011f);  // half a pixel
  EXPECT_LT(t.residual, 0.05);
}

TEST(SpacingOf, IsThatOfTheLatticeWhateverCopiesThereAre) {
  std::vector<vec3> points;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 30; ++x) points.push_back({0.02f * x, 0.02f * y, 0});
  }
  EXPECT_NEAR(spacingOf(points), 0.02, 1e-6);
  for (std::size_t i = 0; i < 300; ++i) points.push_back(points[i] + vec3(1e-6f, 0, 0));
  EXPECT_NEAR(spacingOf(points), 0.02, 0.006);
}

TEST(TrackJoints, StandsStillWithTheSubject) {
  const SphereCapture s{.cameras = 12};
  const auto views = photographsAt(s, s.center);
  const TrackJointsOptions o = quick();
  const GaussianCloud first = firstJoints(views, o);
  Progress progress;
  const TrackedJoints t = trackJoints(views, {poseOf(first), first, {}}, o, *makeCpuDevice(), progress);
  EXPECT_LT(medianError(first, t.joints, vec3(0)), 0.011f);
}

TEST(TrackJoints, GivesTheSameBitsForAnyNumberOfThreads) {
  const SphereCapture s{.cameras = 6};
  TrackJointsOptions o = quick();
  o.first_iterations = o.iterations = 40;
  const GaussianCloud first = firstJoints(photographsAt(s, s.center), o);
  const auto next = photographsAt(s, s.center + vec3(0.03f, 0, 0));
  Progress a, b;
  setThreadCount(1);
  const TrackedJoints one = trackJoints(next, {poseOf(first), first, {}}, o, *makeCpuDevice(), a);
  setThreadCount(2);
  const TrackedJoints two = trackJoints(next, {poseOf(first), first, {}}, o, *makeCpuDevice(), b);
  setThreadCount(0);
  EXPECT_EQ(one.joints.position_m, two.joints.position_m);
  EXPECT_EQ(one.joints.rotation, two.joints.rotation);
  EXPECT_EQ(one.residual, two.residual);
  EXPECT_EQ(one.rigid, two.rigid);
}

TEST(TrackJoints, AHistoryOfOtherJointsIsRefused) {
  const SphereCapture s{.cameras = 6};
  TrackJointsOptions o = quick();
  o.first_iterations = 20;
  const auto views = photographsAt(s, s.center);
  const GaussianCloud first = firstJoints(views, o);
  const std::vector<vec3> other(first.size() - 1);
  Progress progress;
  EXPECT_THROW(trackJoints(views, {poseOf(first), first, other}, o, *makeCpuDevice(), progress), Error);
}

TEST(TrackJoints, StopsWhenAskedTo) {
  const SphereCapture s{.cameras = 6};
  TrackJointsOptions o = quick();
  o.first_iterations = 20;
  const auto views = photographsAt(s, s.center);
  const GaussianCloud first = firstJoints(views, o);
  o.iterations = 1000000;
  std::stop_source stop;
  Progress progress(stop.get_token(), [&](const ProgressReport& r) {
    if (r.fraction > 0) stop.request_stop();
  });
  EXPECT_THROW(trackJoints(views, {poseOf(first), first, {}}, o, *makeCpuDevice(), progress), Cancelled);
}

}  // namespace
}  // namespace beam
