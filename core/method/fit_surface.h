// SPDX-License-Identifier: Apache-2.0
// One frame's Gaussians from its photographs (BEAM 3.1): growth by MCMC to a cap under E_color, then
// E_normal.
#pragma once

#include <span>

#include "core/base/fields.h"
#include "core/base/progress.h"
#include "core/method/preview.h"
#include "core/method/view_loss.h"
#include "core/optim/learning_rates.h"
#include "core/scene/frame_views.h"

namespace beam {

struct FitSurfaceOptions {
  int iterations = 30000;        // optimiser steps in all: 15,000 + 15,000 for a lone frame (methods 3.7)
  double refine_fraction = 0.5;  // share of the steps that run with E_normal
  int cap = 140000;              // Gaussians (BEAM fig. 8)
  int seed = 1;
  double seed_share = 0.4;   // seeds as a share of the cap
  double ssim_weight = 0.2;  // lambda of eq. 8
  double mask_weight = 0.1;  // methods 3.8
  double filter = 1.0;       // 3D filter, relative to methods 1.3
  ModelRates rates = kFirstFrameRates;
  double noise = 5e5;  // MCMC (methods 1.12)
  double opacity_regularizer = 0.01;
  double scale_regularizer = 0.01;
  double isotropy_weight = 0;  // of joints only (methods 3.2); not settings of Surface
  double size_weight = 0;
  double normal_weight = 0.03;        // lambda_normal, BEAM 3.1; group "refine"
  double expected_depth_share = 0.4;  // of E_normal (methods 2.7); group "refine"
};
void describe(Fields& fields, FitSurfaceOptions& options);
// 1.1 x the radius of the camera centres around their mean, metres: what position rates are relative to
// (methods 1.11).
float sceneExtent(std::span<const FrameView> views);
ViewLossOptions lossOptions(const FitSurfaceOptions& options);

// Appearance: growth and E_color; steps [0, iterations * (1 - refine_fraction)). Deterministic for a seed.
GaussianCloud fitAppearance(std::span<const FrameView> views, const PointCloud& seeds,
                            const FitSurfaceOptions& options, ComputeDevice& device, Progress& progress,
                            const CloudPreview& preview = {});

// Geometry: E_color + E_normal with a fixed count, then hull pruning; the remaining steps.
GaussianCloud refineGeometry(std::span<const FrameView> views, const GaussianCloud& cloud,
                             const FitSurfaceOptions& options, ComputeDevice& device, Progress& progress,
                             const CloudPreview& preview = {});

}  // namespace beam
