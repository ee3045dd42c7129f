// SPDX-License-Identifier: Apache-2.0
// Learning rates of Adam: every number of the house once. Options take these tables as their defaults and
// settings change them; `ratesAt` and `shareAt` give what a step takes. All rates are >= 0 and fall
// log-linearly over a fit, or stay (methods 1.11).
#pragma once

#include "core/optim/schedule.h"

namespace beam {

// Of the Gaussians' own values in one step, a rate each group of planes; 0: the planes rest.
struct LearningRates {
  float position_m = 0;
  float rotation = 0;  // of a quaternion's numbers
  float log_scale = 0;
  float opacity_logit = 0;
  float color_dc = 0;    // SH band 0
  float color_rest = 0;  // bands 1 to 3
};

// Share of the first rate at which those of joints and of frames that follow another end (ours). A float's
// 0.1: results depend on it.
inline constexpr double kEndOfLaterFits = 0.1f;

// What the Gaussians of a fit learn with at its first step.
struct ModelRates {
  double position = 0;  // in extents of the scene
  double rotation = 0;
  double log_scale = 0;
  double opacity_logit = 0;
  double color = 0;          // SH band 0
  float rest_divisor = 20;   // bands 1 to 3 learn so many times slower
  double position_last = 1;  // share of its first rate at which a position ends
  double last = 1;           // likewise all others
};

// What a pose learns with at the first step.
struct PoseRates {
  double position = 0;  // in a length that stands with the table
  double rotation = 0;  // of a quaternion's numbers: half an angle in radians
  double last = kEndOfLaterFits;
};

// A frame fitted alone or the first of a take, its joints too (methods 1.11, 1.12).
inline constexpr ModelRates kFirstFrameRates{.position = 1.6e-4,
                                             .rotation = 1e-3,
                                             .log_scale = 5e-3,
                                             .opacity_logit = 0.05,
                                             .color = 2.5e-3,
                                             .rest_divisor = 20,
                                             .position_last = 0.01};
// The skin of a frame that follows another: it is moved by its joints alone (methods 3.6).
inline constexpr ModelRates kLaterFrameRates{
    .log_scale = 5e-4, .opacity_logit = 2.5e-3, .color = 2.5e-4, .rest_divisor = 2, .last = kEndOfLaterFits};
// The joints' colours as the body turns in the light (ours).
inline constexpr ModelRates kShadingRates{.color = 0.01f, .last = kEndOfLaterFits};

inline constexpr PoseRates kTrackedJointRates{.position = 0.05, .rotation = 2e-3};    // in pixels (ours)
inline constexpr PoseRates kCorrectedJointRates{.position = 0.05, .rotation = 1e-3};  // in pixels (ours)
inline constexpr PoseRates kResidualRates{.position = 1.6e-5, .rotation = 1e-3};  // in extents (methods 3.7)

// What is left of a first rate at `step` of `steps`.
inline float shareAt(double last, int step, int steps) {
  return static_cast<float>(logLinear(1, last, step, steps));
}

inline LearningRates ratesAt(const ModelRates& first, int step, int steps, float extent_m) {
  const float share = shareAt(first.last, step, steps);
  LearningRates r;
  r.position_m = static_cast<float>(first.position) * shareAt(first.position_last, step, steps) * extent_m;
  r.rotation = static_cast<float>(first.rotation) * share;
  r.log_scale = static_cast<float>(first.log_scale) * share;
  r.opacity_logit = static_cast<float>(first.opacity_logit) * share;
  r.color_dc = static_cast<float>(first.color) * share;
  r.color_rest = r.color_dc / first.rest_divisor;
  return r;
}

}  // namespace beam
