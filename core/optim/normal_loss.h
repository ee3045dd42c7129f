// SPDX-License-Identifier: Apache-2.0
// E_normal (BEAM eq. 1 in the form of methods 2.6-2.7): per pixel A - S . N_d, averaged over the pixels of
// the picture, S the blended normals, A their coverage, N_d the normal that the rendered depth implies.
#pragma once

#include "core/render/rasterizer.h"

namespace beam {

struct NormalLossOptions {
  float weight = 0.03f;         // lambda_normal
  float expected_share = 0.4f;  // share on the expected depth, the rest on the median (RaDe's code)
  double pixels = 0;            // what the mean divides by; 0: the pixels of the picture
};

// Unit normals in camera axes from z-depth, facing the camera; 0 at borders, where alpha < 0.5 in the
// neighbourhood, and across depth edges (|dz| > max(0.02 m, 3 x the neighbourhood's median)).
Planes normalsFromDepth(const Planes& depth, const Planes& alpha, const Intrinsics& intrinsics);

// Returns the loss and adds its gradient to `upstream` (planes alpha, normal, depth, median_depth; sized on
// demand).
double normalLoss(const RasterImages& images, const Intrinsics& intrinsics, const NormalLossOptions& options,
                  RasterImages& upstream);

}  // namespace beam
