// SPDX-License-Identifier: Apache-2.0
// Fits the 2D maps as third-order SH of the Gaussians (methods 5.10): a linear least-squares solve on cached
// blend weights; the paper's L1 + D-SSIM descent as an option.
#pragma once

#include <functional>
#include <span>

#include "core/base/fields.h"
#include "core/base/progress.h"
#include "core/method/bake_materials.h"

namespace beam {

// Of frames that follow another in a take.
struct LaterMaterialsOptions {
  double memory_frames = 4;  // linear: what the frame before counts for, in frames' evidence
  // linear: the same of AO, which really changes: a tenth (methods 5.10)
  double occlusion_memory_frames = 0.4;
  double outlier = 0.1;           // linear: contradiction that halves and more the memory, sRGB
  double temporal_weight = 5e-5;  // adam: lambda_temp of eq. 10, base colour only
  int adam_iterations = 1500;     // methods 5.10
};

struct FitMaterialsOptions {
  std::string solver = "adam";   // "adam": the paper's 5,000 steps each; "linear": conjugate gradients
  int adam_iterations = 5000;    // BEAM 3.2
  int linear_iterations = 30;    // conjugate-gradient steps
  double regularization = 1e-4;  // on the view-dependent coefficients (methods 5.10)
  LaterMaterialsOptions later = {};
};
void describe(Fields& fields, FitMaterialsOptions& options);
void describe(Fields& fields, LaterMaterialsOptions& options);

// The maps of several views, read when they are needed: the linear solver has one view's in memory, "adam"
// all.
struct MapSource {
  std::size_t views = 0;
  std::function<MaterialMaps(std::size_t view)> read;
  std::function<MaterialMaps(std::size_t view)> read_weights;  // camera and weights alone
};
MapSource sourceOf(std::span<const MaterialMaps> maps);  // which it refers to

Materials fitMaterials(const MapSource& maps, const GaussianCloud& cloud, float roughness,
                       const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress);

// The finished frame before: the same Gaussians in the same order.
struct EarlierFrame {
  const GaussianCloud& cloud;
  const Materials& materials;
};

// Of a later frame of a take: held to the frame before, whose view-dependence turns with each Gaussian
// (methods A-19); carries its roughness. Throws Error{Bug} when the counts differ.
Materials fitLaterMaterials(const MapSource& maps, const GaussianCloud& cloud, const EarlierFrame& before,
                            const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress);

}  // namespace beam
