// SPDX-License-Identifier: Apache-2.0
#include "core/method/joint_warp.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/quaternion.h"

namespace beam {
namespace {

constexpr std::size_t kGrain = 1024;

float side(quat a, quat b) { return glm::dot(a, b) < 0 ? -1.0f : 1.0f; }

}  // namespace

JointWarp::JointWarp(Pose skin_at_rest, Pose joints_at_rest, Anchors anchors)
    : skin_(std::move(skin_at_rest)),
      joints_(std::move(joints_at_rest)),
      anchors_(std::move(anchors)),
      lists_(listsOf(anchors_, joints_.size())) {
  if (anchors_.points() != skin_.size())
    throw Error(Error::Kind::Bug,
                fmt::format("{} skin Gaussians with anchors for {}", skin_.size(), anchors_.points()));
  for (quat& q : joints_.rotation) q = glm::normalize(q);
}

std::vector<quat> JointWarp::turns(const Pose& joints) const {
  if (joints.size() != joints_.size())
    throw Error(Error::Kind::Bug,
                fmt::format("a pose of {} joints for a warp of {}", joints.size(), joints_.size()));
  std::vector<quat> r(joints.size());
  for (std::size_t k = 0; k < r.size(); ++k) {
    r[k] = glm::normalize(joints.rotation[k]) * glm::conjugate(joints_.rotation[k]);
  }
  return r;
}

quat JointWarp::blend(const std::vector<quat>& turns, std::size_t i) const {
  const auto n = static_cast<std::size_t>(anchors_.per_point);
  const quat nearest = turns[anchors_.target[i * n]];
  vec4 sum(0);
  for (std::size_t s = i * n; s < (i + 1) * n; ++s) {
    const quat r = turns[anchors_.target[s]];
    sum += anchors_.weight[s] * side(r, nearest) * toVec4(r);
  }
  return toQuat(sum);
}

Pose JointWarp::skin(const Pose& joints) const {
  const std::vector<quat> r = turns(joints);
  const auto n = static_cast<std::size_t>(anchors_.per_point);
  Pose out{std::vector<vec3>(skin_.size()), std::vector<quat>(skin_.size())};
  parallelFor(skin_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      vec3 x(0);
      for (std::size_t s = i * n; s < (i + 1) * n; ++s) {
        const std::uint32_t k = anchors_.target[s];
        x += anchors_.weight[s] *
             (r[k] * (skin_.position_m[i] - joints_.position_m[k]) + joints.position_m[k]);
      }
      out.position_m[i] = x;
      out.rotation[i] = glm::normalize(blend(r, i)) * skin_.rotation[i];
    }
  });
  return out;
}

void JointWarp::backward(const Pose& joints, const PoseGradient& skin_gradient,
                         PoseGradient& gradient) const {
  const std::vector<quat> r = turns(joints);
  const auto n = static_cast<std::size_t>(anchors_.per_point);
  std::vector<vec4> d_blend(skin_.size());
  parallelFor(skin_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const vec4 d_unit = throughRightProduct(skin_gradient.rotation[i], skin_.rotation[i]);
      d_blend[i] = throughNormalize(blend(r, i), d_unit);
    }
  });
  parallelFor(joints.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      vec3 d_position(0);
      vec4 d_turn(0);
      for (std::uint32_t l = lists_.first[k]; l < lists_.first[k + 1]; ++l) {
        const std::uint32_t s = lists_.slot[l];
        const std::size_t i = s / n;
        const float w = anchors_.weight[s];
        const vec3 g = w * skin_gradient.position[i];
        d_position += g;
        d_turn += rotatedGradient(r[k], skin_.position_m[i] - joints_.position_m[k], g);
        d_turn += w * side(r[k], r[anchors_.target[i * n]]) * d_blend[i];
      }
      gradient.position[k] += d_position;
      gradient.rotation[k] += throughNormalize(
          joints.rotation[k], throughRightProduct(d_turn, glm::conjugate(joints_.rotation[k])));
    }
  });
}

void JointWarp::backwardToRest(const Pose& joints, const PoseGradient& skin_gradient,
                               PoseGradient& gradient) const {
  const std::vector<quat> r = turns(joints);
  const auto n = static_cast<std::size_t>(anchors_.per_point);
  parallelFor(skin_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      vec3 sum(0);
      for (std::size_t s = i * n; s < (i + 1) * n; ++s) {
        sum += anchors_.weight[s] * (glm::conjugate(r[anchors_.target[s]]) * skin_gradient.position[i]);
      }
      gradient.position[i] += sum;
      gradient.rotation[i] += throughLeftProduct(glm::normalize(blend(r, i)), skin_gradient.rotation[i]);
    }
  });
}

void JointWarp::setRestSkin(Pose skin) {
  if (skin.size() != skin_.size())
    throw Error(Error::Kind::Bug,
                fmt::format("{} skin Gaussians for a warp of {}", skin.size(), skin_.size()));
  skin_ = std::move(skin);
}

}  // namespace beam
