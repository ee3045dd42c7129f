// SPDX-License-Identifier: Apache-2.0
// A pose under optimisation: Adam over positions and quaternions.
#pragma once

#include "core/optim/anchors.h"
#include "core/render/training_ops.h"

namespace beam {

class PoseModel {
 public:
  explicit PoseModel(Pose pose);

  const Pose& pose() const { return pose_; }
  // One step of Adam; `step` counts from 1. Quaternions are normalised afterwards.
  void step(const PoseGradient& gradient, float position_rate_m, float rotation_rate, int step,
            TrainingOps& ops);

 private:
  Pose pose_;
  GaussianBuffers values_, gradient_, first_moment_, second_moment_;
};

// The planes that hold a pose.
void setPose(GaussianBuffers& buffers, const Pose& pose);
void readPose(const GaussianBuffers& buffers, Pose& pose);
// From dL/d(planes); adds.
void addPoseGradient(const GaussianBuffers& gradients, PoseGradient& gradient);

}  // namespace beam
