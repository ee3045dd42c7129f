// SPDX-License-Identifier: Apache-2.0
#include "core/optim/pose_model.h"

#include <array>

#include "core/base/parallel.h"

namespace beam {
namespace {

using L = PlaneLayout;
constexpr std::size_t kGrain = 4096;

}  // namespace

PoseModel::PoseModel(Pose pose)
    : pose_(std::move(pose)),
      values_(pose_.size()),
      gradient_(pose_.size()),
      first_moment_(pose_.size()),
      second_moment_(pose_.size()) {
  setPose(values_, pose_);
}

void PoseModel::step(const PoseGradient& gradient, float position_rate_m, float rotation_rate, int step,
                     TrainingOps& ops) {
  for (std::size_t i = 0; i < pose_.size(); ++i) {
    for (int k = 0; k < 3; ++k) gradient_.plane(L::kPosition + k)[i] = gradient.position[i][k];
    for (int k = 0; k < 4; ++k) gradient_.plane(L::kRotation + k)[i] = gradient.rotation[i][k];
  }
  std::array<AdamPlane, L::kExtra> planes{};
  for (int k = 0; k < 3; ++k) planes[L::kPosition + k].learning_rate = position_rate_m;
  for (int k = 0; k < 4; ++k) planes[L::kRotation + k].learning_rate = rotation_rate;
  ops.adam(values_, gradient_, first_moment_, second_moment_, planes, AdamSettings{}, step);
  readPose(values_, pose_);
  for (quat& q : pose_.rotation) q = glm::normalize(q);
  setPose(values_, pose_);
}

void setPose(GaussianBuffers& buffers, const Pose& pose) {
  parallelFor(pose.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (int k = 0; k < 3; ++k) buffers.plane(L::kPosition + k)[i] = pose.position_m[i][k];
      const quat& q = pose.rotation[i];
      const float wxyz[4] = {q.w, q.x, q.y, q.z};
      for (int k = 0; k < 4; ++k) buffers.plane(L::kRotation + k)[i] = wxyz[k];
    }
  });
}

void readPose(const GaussianBuffers& buffers, Pose& pose) {
  pose.position_m.resize(buffers.count);
  pose.rotation.resize(buffers.count);
  const auto at = [&](int plane, std::size_t i) { return buffers.plane(plane)[i]; };
  parallelFor(buffers.count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      pose.position_m[i] = {at(L::kPosition, i), at(L::kPosition + 1, i), at(L::kPosition + 2, i)};
      pose.rotation[i] = quat(at(L::kRotation, i), at(L::kRotation + 1, i), at(L::kRotation + 2, i),
                              at(L::kRotation + 3, i));
    }
  });
}

void addPoseGradient(const GaussianBuffers& gradients, PoseGradient& gradient) {
  parallelFor(gradients.count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (int k = 0; k < 3; ++k) gradient.position[i][k] += gradients.plane(L::kPosition + k)[i];
      for (int k = 0; k < 4; ++k) gradient.rotation[i][k] += gradients.plane(L::kRotation + k)[i];
    }
  });
}

}  // namespace beam
