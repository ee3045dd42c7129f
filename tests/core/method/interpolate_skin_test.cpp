// SPDX-License-Identifier: Apache-2.0
// Laws of frames between frames: the ends are the ends, half of a rigid motion is half the motion, half turns
// do not tear, and what differs in count is refused.
#include "core/method/interpolate_skin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/method/joint_warp.h"
#include "tests/support/random_pose.h"

namespace beam {
namespace {

using testing::moved;
using testing::randomPose;

const Pose kJoints = randomPose(60, 0.5f, 1), kRestSkin = randomPose(120, 0.5f, 2);

GaussianCloud cloudAt(const Pose& pose, float value) {
  GaussianCloud cloud;
  setPose(cloud, pose);
  cloud.scale_m.assign(pose.size(), vec3(0.01f * value));
  cloud.opacity.assign(pose.size(), 0.5f * value);
  cloud.color = ShBlock(pose.size(), 3);
  cloud.color.coefficients.assign(cloud.color.coefficients.size(), value);
  return cloud;
}

CarriedSkin skinOn(const Pose& joints, float value = 1) {
  const JointWarp warp(kRestSkin, kJoints, boundTo(kRestSkin, kJoints));
  return {cloudAt(warp.skin(joints), value), kRestSkin, joints};
}

void expectSame(const Pose& a, const Pose& b, float tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT(glm::length(a.position_m[i] - b.position_m[i]), tolerance) << i;
    EXPECT_GT(std::abs(glm::dot(a.rotation[i], b.rotation[i])), 1 - 1e-4f) << i;
  }
}

quat turnOf(float degrees) {
  return glm::angleAxis(glm::radians(degrees), glm::normalize(vec3(0.3f, 1, -0.2f)));
}

TEST(InterpolateSkin, IsEitherFrameAtItsEnds) {
  CarriedSkin a = skinOn(moved(kJoints, turnOf(20), vec3(0.1f)), 0.4f);
  CarriedSkin b = skinOn(moved(kJoints, turnOf(95), vec3(0, 0.3f, 0)), 0.8f);
  // Skins that are not where their joints carry them, and joints that do not move as one.
  const Pose noise = randomPose(kRestSkin.size(), 0.05f, 3);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    b.cloud.position_m[i] += noise.position_m[i];
    b.cloud.rotation[i] = glm::normalize(glm::slerp(b.cloud.rotation[i], noise.rotation[i], 0.2f));
    b.rest_skin.position_m[i] += 0.1f * noise.position_m[i];
  }
  for (std::size_t k = 0; k < kJoints.size(); ++k)
    a.joints.rotation[k] = glm::slerp(a.joints.rotation[k], noise.rotation[k], 0.1f);
  const GaussianCloud first = interpolateSkin(a, b, kJoints, 0), last = interpolateSkin(a, b, kJoints, 1);
  expectSame(poseOf(first), poseOf(a.cloud), 2e-6f);
  expectSame(poseOf(last), poseOf(b.cloud), 2e-6f);
  EXPECT_EQ(first.scale_m, a.cloud.scale_m);
  EXPECT_EQ(last.opacity, b.cloud.opacity);
  EXPECT_EQ(last.color.coefficients, b.cloud.color.coefficients);
}

// On the arc about the turn's own axis, not on the chord.
TEST(InterpolateSkin, GoesThroughHalfOfARigidMotion) {
  const vec3 centre(2, 0, 1), lift = 0.4f * glm::axis(turnOf(90));
  const auto at = [&](float share) {
    const quat turn = turnOf(90 * share);
    return moved(kJoints, turn, centre - turn * centre + share * lift);
  };
  for (const float share : {0.1f, 0.5f, 0.8f}) {
    const GaussianCloud between = interpolateSkin(skinOn(at(0)), skinOn(at(1)), kJoints, share);
    expectSame(poseOf(between), poseOf(skinOn(at(share)).cloud), 5e-6f);
  }
}

TEST(InterpolateSkin, ShiftsWithoutATurn) {
  const Pose there = moved(kJoints, quat(1, 0, 0, 0), vec3(1, 2, 3));
  expectSame(interpolateJoints(kJoints, there, 0.25),
             moved(kJoints, quat(1, 0, 0, 0), vec3(0.25f, 0.5f, 0.75f)), 1e-6f);
}

TEST(InterpolateSkin, DoesNotMindTheSignsOfQuaternions) {
  const Pose there = moved(kJoints, turnOf(70), vec3(0.2f, 0, 0));
  Pose signs = there;
  for (std::size_t k = 0; k < signs.size(); k += 2) signs.rotation[k] = -signs.rotation[k];
  expectSame(interpolateJoints(kJoints, signs, 0.5), interpolateJoints(kJoints, there, 0.5), 1e-6f);
}

// Some joints a little less than half a turn and some a little more: all go the same way round.
TEST(InterpolateSkin, DoesNotTearAtHalfTurns) {
  Pose there = kJoints;
  for (std::size_t k = 0; k < there.size(); ++k) {
    const quat turn = turnOf(k % 2 ? 179 : 181);
    there.position_m[k] = turn * there.position_m[k];
    there.rotation[k] = turn * there.rotation[k];
  }
  const Pose between = interpolateJoints(kJoints, there, 0.5);
  const quat way = between.rotation[0] * glm::conjugate(kJoints.rotation[0]);
  for (std::size_t k = 0; k < there.size(); ++k) {
    const quat turn = between.rotation[k] * glm::conjugate(kJoints.rotation[k]);
    EXPECT_GT(std::abs(glm::dot(turn, way)), 0.99f) << k;
    EXPECT_NEAR(glm::length(between.position_m[k]), glm::length(kJoints.position_m[k]), 1e-5) << k;
  }
}

TEST(InterpolateSkin, BlendsPhysicalValues) {
  const GaussianCloud between = interpolateSkin(skinOn(kJoints, 0.4f), skinOn(kJoints, 0.8f), kJoints, 0.25);
  EXPECT_NEAR(between.scale_m[3].y, 0.005f, 1e-7);
  EXPECT_NEAR(between.opacity[3], 0.25f, 1e-6);
  EXPECT_NEAR(between.color.coefficients[5], 0.5f, 1e-6);
  Materials a{{0.2f, 0.4f}, ShBlock(2, 3), ShBlock(2, 1)}, b{{0.6f, 0.4f}, ShBlock(2, 3), ShBlock(2, 1)};
  b.base_color.coefficients[1] = 1;
  b.ambient_occlusion.coefficients[2] = -1;
  const Materials m = interpolateMaterials(a, b, 0.25);
  EXPECT_NEAR(m.roughness[0], 0.3f, 1e-6);
  EXPECT_NEAR(m.base_color.coefficients[1], 0.25f, 1e-6);
  EXPECT_NEAR(m.ambient_occlusion.coefficients[2], -0.25f, 1e-6);
}

TEST(InterpolateSkin, RefusesOtherCounts) {
  const auto refused = [](auto&& call) {
    try {
      call();
      return false;
    } catch (const Error& e) {
      return e.kind() == Error::Kind::Data;
    }
  };
  const CarriedSkin a = skinOn(kJoints);
  CarriedSkin fewer = a;
  fewer.cloud = cloudAt(randomPose(7, 1, 4), 1);
  EXPECT_TRUE(refused([&] { interpolateSkin(a, fewer, kJoints, 0.5); }));
  CarriedSkin joints = a;
  joints.joints = randomPose(7, 1, 4);
  EXPECT_TRUE(refused([&] { interpolateSkin(a, joints, kJoints, 0.5); }));
  EXPECT_TRUE(refused([&] { interpolateMaterials({{0.5f}, {}, {}}, {{0.5f, 0.5f}, {}, {}}, 0.5); }));
}

}  // namespace
}  // namespace beam
