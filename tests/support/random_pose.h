// SPDX-License-Identifier: Apache-2.0
// Random poses, and a plain motion of all of them.
#pragma once

#include "core/base/rng.h"
#include "core/optim/anchors.h"

namespace beam::testing {

inline quat randomTurn(const RandomStream& random, std::uint64_t at) {
  return glm::normalize(
      quat(random.normal(at), random.normal(at + 1), random.normal(at + 2), random.normal(at + 3)));
}

// Points in a box of `size_m`, turned anyhow.
inline Pose randomPose(std::size_t count, float size_m, std::uint64_t seed) {
  const RandomStream random(seed, 0, 0);
  Pose pose;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t at = i * 7;
    pose.position_m.push_back(size_m *
                              vec3(random.uniform(at), random.uniform(at + 1), random.uniform(at + 2)));
    pose.rotation.push_back(randomTurn(random, at + 3));
  }
  return pose;
}

// x' = turn x + shift, q' = turn q.
inline Pose moved(const Pose& pose, quat turn, vec3 shift) {
  Pose out = pose;
  for (vec3& x : out.position_m) x = turn * x + shift;
  for (quat& q : out.rotation) q = turn * q;
  return out;
}

// Every number of the pose with the number of the gradient that belongs to it.
template <class Visit>
void forEachNumber(Pose& pose, const PoseGradient& gradient, Visit&& visit) {
  for (std::size_t i = 0; i < pose.size(); ++i) {
    for (int k = 0; k < 3; ++k) visit(pose.position_m[i][k], gradient.position[i][k]);
    quat& q = pose.rotation[i];
    float* wxyz[4] = {&q.w, &q.x, &q.y, &q.z};
    for (int k = 0; k < 4; ++k) visit(*wxyz[k], gradient.rotation[i][k]);
  }
}

}  // namespace beam::testing
