// SPDX-License-Identifier: Apache-2.0
// The paper's way to fit material maps (BEAM 3.2): L1 + D-SSIM by Adam through the rasteriser, one map kind a
// run.
#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/method/fit_materials.h"

namespace beam {

enum class MapKind { BaseColor, AmbientOcclusion };

struct DescentOptions {
  MapKind kind;
  int iterations;
  double regularization;   // on the view-dependent coefficients
  double temporal_weight;  // lambda_temp: times the sum of squared changes since `start` (BEAM eq. 10)
};

// Three channels a Gaussian: [(gaussian * kShCount + k) * 3 + c]; AO's are three times the same. Starts from
// `start`.
ShBlock fitDescent(std::span<const MaterialMaps> maps, const GaussianCloud& cloud, const ShBlock& start,
                   const DescentOptions& options, ComputeDevice& device, Progress& progress);

}  // namespace beam
