// SPDX-License-Identifier: Apache-2.0
// The skin follows a textured sphere that moves and turns: each Gaussian stays on its piece of surface, the
// picture stays as good as that of the first frame, and the bits repeat.
#include "core/method/follow_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/method/score_views.h"
#include "core/method/seed_points.h"
#include "core/optim/pose_model.h"
#include "tests/support/random_pose.h"
#include "tests/support/sphere_capture.h"

namespace beam {
namespace {

using testing::SphereCapture;

// The sphere after a turn about +Y and a shift, seen by the cameras of the first.
std::vector<FrameView> photographsOf(const SphereCapture& s, float angle, vec3 shift) {
  std::vector<FrameView> views = testing::photographs(s);
  SphereCapture moved = s;
  moved.center += shift;
  moved.turn = glm::angleAxis(angle, vec3(0, 1, 0));
  for (FrameView& v : views) v = testing::photographSphere(moved, v.camera, v.name);
  return views;
}

struct Scene {
  SphereCapture sphere{.cameras = 12};
  FitSurfaceOptions fit;
  FollowSurfaceOptions later;
  std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  GaussianCloud first;
  Pose joints;

  Scene() {
    fit.iterations = 500;
    fit.refine_fraction = 0;
    fit.cap = 1500;
    fit.filter = 0;
    later.iterations = 300;
    later.refine_fraction = 0.4;
    later.rates.color = 2.5e-3;
    Progress progress;
    Progress a = progress.part(0.1, "seeds"), b = progress.part(0.9, "fit");
    const auto views = photographsOf(sphere, 0, vec3(0));
    const PointCloud seeds = seedPoints(views, {}, 700, 1, a);
    first = fitAppearance(views, seeds, fit, *device, b);
    const PointCloud carriers = seedPoints(views, {}, 200, 2, progress);
    joints.position_m = carriers.position_m;
    joints.rotation.assign(joints.size(), quat(1, 0, 0, 0));
  }

  // About the sphere's middle.
  Pose turned(float angle, vec3 shift) const {
    const quat turn = glm::angleAxis(angle, vec3(0, 1, 0));
    return testing::moved(joints, turn, sphere.center - turn * sphere.center + shift);
  }

  FollowedSkin follow(const std::vector<FrameView>& views, const Pose& start) const {
    const CarriedSkin previous{first, poseOf(first), joints};
    const FollowInput input{previous, joints, start};
    Progress a, b;
    const FollowedSkin fitted = followAppearance(views, input, fit, later, *device, a);
    return followGeometry(views, input, fitted, fit, later, *device, b);
  }

  double psnr(const std::vector<FrameView>& views, const GaussianCloud& cloud) const {
    Progress progress;
    return meanOf(scoreViews(views, false, cloud, *device, progress), false).mean.psnr;
  }
};

const Scene& scene() {
  static const Scene kScene;
  return kScene;
}

TEST(FollowSurface, KeepsThePictureAndThePiecesOfSurfaceThroughAMotion) {
  const Scene& s = scene();
  const float angle = 0.5f;
  const vec3 shift(0.1f, 0.03f, -0.05f);
  const auto views = photographsOf(s.sphere, angle, shift);
  Pose start = s.turned(angle, shift);
  for (std::size_t k = 0; k < start.size(); ++k) {  // a tracker that is a pixel off
    start.position_m[k] += vec3(0.006f, -0.006f, 0.006f);
  }
  const FollowedSkin skin = s.follow(views, start);
  ASSERT_EQ(skin.cloud.size(), s.first.size());
  const quat turn = glm::angleAxis(angle, vec3(0, 1, 0));
  std::vector<float> error;
  for (std::size_t i = 0; i < s.first.size(); ++i) {
    const vec3 there = turn * (s.first.position_m[i] - s.sphere.center) + s.sphere.center + shift;
    error.push_back(glm::length(skin.cloud.position_m[i] - there));
  }
  std::nth_element(error.begin(), error.begin() + error.size() / 2, error.end());
  EXPECT_LT(error[error.size() / 2], 0.005f);
  EXPECT_GT(s.psnr(views, skin.cloud), s.psnr(photographsOf(s.sphere, 0, vec3(0)), s.first) - 1);
}

TEST(FollowSurface, AStandingSubjectStands) {
  const Scene& s = scene();
  const auto views = photographsOf(s.sphere, 0, vec3(0));
  const FollowedSkin skin = s.follow(views, s.joints);
  float farthest = 0;
  for (std::size_t i = 0; i < s.first.size(); ++i) {
    farthest = std::max(farthest, glm::length(skin.cloud.position_m[i] - s.first.position_m[i]));
  }
  EXPECT_LT(farthest, 0.02f);
  EXPECT_GT(s.psnr(views, skin.cloud), s.psnr(views, s.first) - 0.1);
}

TEST(FollowSurface, WithoutResidualsTheSkinAtRestStays) {
  Scene s = scene();
  s.later.residual = false;
  s.later.iterations = 20;
  const FollowedSkin skin = s.follow(photographsOf(s.sphere, 0.1f, vec3(0)), s.turned(0.1f, vec3(0)));
  EXPECT_EQ(skin.rest_skin.position_m, s.first.position_m);
}

TEST(FollowSurface, AHeavyTemporalTermKeepsTheAppearance) {
  Scene s = scene();
  s.later.iterations = 60;
  auto dimmed = photographsOf(s.sphere, 0, vec3(0));
  for (FrameView& v : dimmed) {
    for (u8vec3& p : v.photo.pixels) p = u8vec3(vec3(p) * 0.5f);
  }
  const double loose = s.follow(dimmed, s.joints).temporal;
  s.later.temporal_weight = 1;
  EXPECT_LT(s.follow(dimmed, s.joints).temporal, 0.2 * loose);
}

TEST(FollowSurface, GivesTheSameBitsForAnyNumberOfThreads) {
  Scene s = scene();
  s.later.iterations = 20;
  const auto views = photographsOf(s.sphere, 0.1f, vec3(0.01f, 0, 0));
  setThreadCount(1);
  const FollowedSkin one = s.follow(views, s.joints);
  setThreadCount(2);
  const FollowedSkin two = s.follow(views, s.joints);
  setThreadCount(0);
  EXPECT_EQ(one.cloud.position_m, two.cloud.position_m);
  EXPECT_EQ(one.cloud.color.coefficients, two.cloud.color.coefficients);
  EXPECT_EQ(one.rest_skin.rotation, two.rest_skin.rotation);
}

TEST(CarriedJoints, RepeatTheCorrectionInTheJointsOwnAxes) {
  const Pose before = testing::randomPose(20, 1, 3);
  const quat turn = glm::angleAxis(2.0f, glm::normalize(vec3(1, 2, 0)));
  const vec3 shift(0.1f, 0.2f, 0.3f);
  Pose corrected = before;
  for (std::size_t k = 0; k < before.size(); ++k) {
    corrected.position_m[k] += before.rotation[k] * vec3(0.01f, 0, 0);
    corrected.rotation[k] = before.rotation[k] * glm::angleAxis(0.2f, vec3(0, 0, 1));
  }
  const Pose carried = carriedJoints(before, corrected, testing::moved(before, turn, shift));
  const Pose expected = testing::moved(corrected, turn, shift);
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_LT(glm::length(carried.position_m[k] - expected.position_m[k]), 1e-5f);
    EXPECT_GT(std::abs(glm::dot(carried.rotation[k], expected.rotation[k])), 1 - 1e-5f);
  }
}

}  // namespace
}  // namespace beam
