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

// Three channels a Gaussian: [(gaussian * kShCount + k) * 3 + c]; AO's are three times the same. Starts from
// `start`.
ShBlock fitDescent(std::span<const MaterialMaps> maps, MapKind kind, const GaussianCloud& cloud,
                   ShBlock start, const FitMaterialsOptions& options, ComputeDevice& device,
                   Progress& progress);

}  // namespace beam
