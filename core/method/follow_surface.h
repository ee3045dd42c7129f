// SPDX-License-Identifier: Apache-2.0
// The skin of a later frame (BEAM 3.1, Appendix A; methods 3.6, 3.7): the Gaussians of the frame before,
// carried there by the joints, then optimised under E_color + E_smooth + E_temp, and with E_normal at the
// end. Count and order never change, so that a Gaussian is the same piece of surface through the whole take.
#pragma once

#include <span>

#include "core/method/fit_surface.h"
#include "core/optim/anchors.h"
#include "core/scene/pose.h"

namespace beam {

struct FollowSurfaceOptions {
  int iterations = 12000;             // optimiser steps of a later frame: 7,000 + 5,000 (BEAM 3.1)
  double refine_fraction = 5.0 / 12;  // share of them with E_normal
  double smooth_weight = 0.001;       // lambda_smooth on the skin graph, a plain sum (methods 3.7)
  double rest_weight = 0;             // ours: E_smooth against the skin at rest
  double temporal_weight = 5e-5;      // lambda_temp of eq. 10, a plain sum over raw values (methods 3.7)
  bool residual = true;               // Gaussians may leave their joints while E_normal acts (methods 3.7)
  double residual_weight = 1e-2;      // ties a Gaussian's residual to the frame before, a plain sum
  PoseRates residual_rates = kResidualRates;
  PoseRates joint_rates = kCorrectedJointRates;
  ModelRates rates = kLaterFrameRates;
};
void describe(Fields& fields, FollowSurfaceOptions& options);

// What a frame's skin hangs on: the Gaussians at rest, with their residuals, and the joints that carry them.
struct CarriedSkin {
  GaussianCloud cloud;  // posed, filter baked in
  Pose rest_skin;       // where the cloud's Gaussians sit on the joints at rest
  Pose joints;          // corrected pose of the joints in this frame
};

struct FollowedSkin : CarriedSkin {
  double smooth_m2 = 0;  // E_smooth against the frame before, without its weight
  double temporal = 0;   // E_temp, likewise
};

struct FollowInput {
  const CarriedSkin& previous;  // of frame t - 1
  const Pose& rest_joints;      // on the rest frame
  const Pose& joints;           // pose to start from in frame t: carriedJoints
};

// What the skin hangs on: its nearest joints, both at rest.
Anchors boundTo(const Pose& skin, const Pose& joints);

// The tracker's joints of this frame with the correction that the skin of the frame before found for its own:
// per joint T_t T_{t-1}^-1 C_{t-1}, T tracked, C corrected.
Pose carriedJoints(const Pose& tracked_before, const Pose& corrected_before, const Pose& tracked);

// Steps [0, iterations * (1 - refine_fraction)): joints, colour, opacity and size under E_color, E_smooth and
// E_temp.
FollowedSkin followAppearance(std::span<const FrameView> views, const FollowInput& input,
                              const FitSurfaceOptions& fit, const FollowSurfaceOptions& options,
                              ComputeDevice& device, Progress& progress, const CloudPreview& preview = {});

// The remaining steps: likewise with E_normal, and with the residuals free where options.residual says so.
// `start`: what followAppearance gave.
FollowedSkin followGeometry(std::span<const FrameView> views, const FollowInput& input,
                            const CarriedSkin& start, const FitSurfaceOptions& fit,
                            const FollowSurfaceOptions& options, ComputeDevice& device, Progress& progress,
                            const CloudPreview& preview = {});

}  // namespace beam
