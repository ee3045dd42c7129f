// SPDX-License-Identifier: Apache-2.0
// Fits the 2D maps as third-order SH of the Gaussians (methods 5.10): a linear least-squares solve on cached
// blend weights; the paper's L1 + D-SSIM descent as an option.
#pragma once

#include <span>

#include "core/base/fields.h"
#include "core/base/progress.h"
#include "core/method/bake_materials.h"

namespace beam {

struct FitMaterialsOptions {
  std::string solver = "adam";   // "adam": the paper's 5,000 steps each; "linear": conjugate gradients
  int adam_iterations = 5000;    // BEAM 3.2
  int linear_iterations = 30;    // conjugate-gradient steps
  double regularization = 1e-4;  // on the view-dependent coefficients (methods 5.10)
};
void describe(Fields& fields, FitMaterialsOptions& options);

Materials fitMaterials(std::span<const MaterialMaps> maps, const GaussianCloud& cloud, float roughness,
                       const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress);

}  // namespace beam
