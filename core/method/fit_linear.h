// SPDX-License-Identifier: Apache-2.0
// The 2D maps as third-order SH by weighted linear least squares (methods 5.10): geometry is fixed, so a
// picture is linear in the coefficients; blend weights are cached once, conjugate gradients do the rest.
#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/method/fit_materials.h"

namespace beam {

// Base colour in xyz, ambient occlusion in w: [gaussian * kShCount + k]. Solved together, as four systems
// that share their matrix's pattern.
using MaterialCoefficients = std::vector<vec4>;

inline constexpr std::size_t kMostBlendWeights = 150'000'000;  // of 8 bytes: 1.2 GB

// `before`: of the same Gaussians in the frame before, turned with them, or null. What is found is
// held to it as options.later says.
// Where the views have more than about `most_entries` blend weights, every so manieth pixel is used.
MaterialCoefficients fitLinear(const MapSource& maps, const GaussianCloud& cloud,
                               const MaterialCoefficients* before, const FitMaterialsOptions& options,
                               ComputeDevice& device, Progress& progress,
                               std::size_t most_entries = kMostBlendWeights);

}  // namespace beam
