// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion (BEAM eq. 3) and base colour (eq. 20) as 2D maps in the input views, from rays traced
// through the Gaussians (eq. 7), denoised; and their weights (methods 5.1-5.9).
#pragma once

#include <functional>
#include <span>

#include "core/base/fields.h"
#include "core/base/progress.h"
#include "core/render/device.h"
#include "core/scene/environment.h"
#include "core/scene/frame_views.h"
#include "core/scene/gaussian_cloud.h"

namespace beam {

struct BakeMaterialsOptions {
  int ao_samples = 50;           // a pixel, eq. 3
  int base_color_samples = 100;  // a pixel, eq. 20
  double offset_m = 0.02;        // epsilon of the ray origin along the normal, BEAM 3.2
  double threshold = 0.9999;     // T of eq. 7
  int denoise_levels = 5;        // of the edge-aware filter on the integrals (methods 5.9); 0: off
  bool multibounce = false;      // one-bounce correction (methods 5.11); the paper ignores inter-reflection
  double roughness = 0.6;        // the stated prior (methods 6.4 a): one number for all Gaussians
  int seed = 1;
};
void describe(Fields& fields, BakeMaterialsOptions& options);

// Maps of one view; value x 1 (surface values, not multiplied by alpha), meaningful where weight > 0.
struct MaterialMaps {
  Camera camera;
  Planes ambient_occlusion;  // 1
  Planes base_color;         // 3, linear
  Planes ao_weight;          // 1, >= 0 (methods 5.7)
  Planes base_color_weight;  // 1
};

// Takes each view's maps twice, so that no other view's are in memory: as soon as they are known, without
// base_color_weight, and when all views are baked with nothing but that, for it depends on the light in all.
using TakeMaps = std::function<void(std::size_t view, const MaterialMaps& maps)>;

void bakeMaterials(std::span<const FrameView> views, const GaussianCloud& cloud,
                   const Environment& environment, const BakeMaterialsOptions& options, ComputeDevice& device,
                   Progress& progress, const TakeMaps& take);

// All of them, in memory.
std::vector<MaterialMaps> bakeMaterials(std::span<const FrameView> views, const GaussianCloud& cloud,
                                        const Environment& environment, const BakeMaterialsOptions& options,
                                        ComputeDevice& device, Progress& progress);

}  // namespace beam
