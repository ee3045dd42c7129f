// SPDX-License-Identifier: Apache-2.0
// Laws of the warp: rigid motions come out rigid, half turns too, signs of quaternions do not matter, and the
// gradient is that of its differences (methods 3.5, 11.5).
#include "core/method/joint_warp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "tests/support/random_pose.h"

namespace beam {
namespace {

using testing::moved;
using testing::randomPose;

const Pose kJoints = randomPose(30, 0.15f, 1), kSkin = randomPose(80, 0.15f, 2);

JointWarp warpOf(const Pose& skin = kSkin) {
  return JointWarp(skin, kJoints, anchorTo(skin.position_m, kJoints.position_m, 8, 0.03f));
}

void expectSamePlaces(const Pose& a, const Pose& b, float tolerance) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT(glm::length(a.position_m[i] - b.position_m[i]), tolerance) << i;
    EXPECT_GT(std::abs(glm::dot(a.rotation[i], b.rotation[i])), 1 - 1e-5f) << i;
  }
}

TEST(JointWarp, LeavesTheSkinAtRestWithTheJointsAtRest) {
  expectSamePlaces(warpOf().skin(kJoints), kSkin, 1e-6f);
}

TEST(JointWarp, MovesTheSkinAsOneWithRigidJointsThroughAWholeTurn) {
  const vec3 axis = glm::normalize(vec3(0.2f, 1, -0.1f));
  for (const float degrees : {10.0f, 90.0f, 179.9f, 180.0f, 180.1f, 270.0f, 359.0f}) {
    const quat turn = glm::angleAxis(glm::radians(degrees), axis);
    expectSamePlaces(warpOf().skin(moved(kJoints, turn, vec3(0.4f, 0, -1))),
                     moved(kSkin, turn, vec3(0.4f, 0, -1)), 3e-6f);
  }
}

TEST(JointWarp, DoesNotSeeTheSignsOfQuaternions) {
  Pose joints = moved(kJoints, glm::angleAxis(3.1f, vec3(0, 1, 0)), vec3(0));
  const Pose expected = warpOf().skin(joints);
  for (std::size_t k = 0; k < joints.size(); k += 2) joints.rotation[k] = -joints.rotation[k];
  expectSamePlaces(warpOf().skin(joints), expected, 1e-6f);
}

TEST(JointWarp, KeepsUnitRotationsWhereJointsDisagree) {
  Pose joints = kJoints;
  const RandomStream random(5, 0, 0);
  for (std::size_t k = 0; k < joints.size(); ++k) joints.rotation[k] = testing::randomTurn(random, 4 * k);
  for (const quat& q : warpOf().skin(joints).rotation) EXPECT_NEAR(glm::length(q), 1, 1e-5);
}

// Joints that stand apart from their rest in any way, and a gradient from above.
struct Disturbed {
  Pose joints = moved(kJoints, glm::angleAxis(0.7f, vec3(0, 1, 0)), vec3(0.05f));
  PoseGradient up{kSkin.size()};

  Disturbed() {
    const Pose noise = randomPose(joints.size(), 0.02f, 9);
    for (std::size_t k = 0; k < joints.size(); ++k) {
      joints.position_m[k] += noise.position_m[k];
      joints.rotation[k] = 0.8f * glm::slerp(joints.rotation[k], noise.rotation[k], 0.1f);
    }
    const RandomStream random(11, 0, 0);
    for (std::size_t i = 0; i < kSkin.size(); ++i) {
      for (int k = 0; k < 3; ++k) up.position[i][k] = random.normal(8 * i + k);
      for (int k = 0; k < 4; ++k) up.rotation[i][k] = 0.1f * random.normal(8 * i + 4 + k);
    }
  }

  double loss(const Pose& skin) const {
    double sum = 0;
    for (std::size_t i = 0; i < skin.size(); ++i) {
      const quat& q = skin.rotation[i];
      sum += glm::dot(dvec3(up.position[i]), dvec3(skin.position_m[i]));
      sum += glm::dot(dvec4(up.rotation[i]), dvec4(q.w, q.x, q.y, q.z));
    }
    return sum;
  }
};

// Against central differences of `loss` in the numbers of `pose`.
template <class Loss>
void expectGradient(Pose& pose, const PoseGradient& gradient, Loss&& loss) {
  double largest = 0, worst = 0;
  testing::forEachNumber(pose, gradient, [&](float& number, float analytic) {
    const float keep = number, h = 2e-3f;
    number = keep + h;
    const double above = loss();
    number = keep - h;
    const double below = loss();
    number = keep;
    const double numeric = (above - below) / (2.0 * h);
    largest = std::max(largest, std::abs(numeric));
    worst = std::max(worst, std::abs(numeric - analytic));
  });
  EXPECT_LT(worst, 1e-3 * largest);
}

TEST(JointWarp, HasTheGradientOfItsDifferences) {
  const JointWarp warp = warpOf();
  Disturbed d;
  PoseGradient gradient(d.joints.size());
  warp.backward(d.joints, d.up, gradient);
  expectGradient(d.joints, gradient, [&] { return d.loss(warp.skin(d.joints)); });
}

TEST(JointWarp, HasTheGradientOfItsDifferencesInTheSkinAtRest) {
  JointWarp warp = warpOf();
  const Disturbed d;
  PoseGradient gradient(kSkin.size());
  warp.backwardToRest(d.joints, d.up, gradient);
  Pose rest = kSkin;
  expectGradient(rest, gradient, [&] {
    warp.setRestSkin(rest);
    return d.loss(warp.skin(d.joints));
  });
}

TEST(JointWarp, GivesTheSameBitsForAnyNumberOfThreads) {
  const Pose skin = randomPose(6000, 0.15f, 3);
  const JointWarp warp = warpOf(skin);
  const Pose joints = moved(kJoints, glm::angleAxis(1.0f, vec3(1, 0, 0)), vec3(0));
  PoseGradient up(skin.size()), one(joints.size()), two(joints.size());
  for (std::size_t i = 0; i < skin.size(); ++i) up.position[i] = skin.position_m[i];
  setThreadCount(1);
  warp.backward(joints, up, one);
  setThreadCount(2);
  warp.backward(joints, up, two);
  setThreadCount(0);
  EXPECT_EQ(one.position, two.position);
  EXPECT_EQ(one.rotation, two.rotation);
}

TEST(JointWarp, RefusesAPoseOfOtherJointsAndAnotherSkin) {
  EXPECT_THROW(warpOf().skin(randomPose(7, 1, 1)), Error);
  JointWarp warp = warpOf();
  EXPECT_THROW(warp.setRestSkin(randomPose(7, 1, 1)), Error);
}

}  // namespace
}  // namespace beam
