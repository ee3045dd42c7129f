// SPDX-License-Identifier: Apache-2.0
// What each Gaussian sees of its surroundings, as degree-3 SH: by it a panorama casts shadows. And which side
// of a Gaussian is the outer one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/render/device.h"
#include "core/scene/camera.h"
#include "core/scene/gaussian_cloud.h"

namespace beam {

// One entry a Gaussian, world axes, metres.
struct SeenSurface {
  // Unit: its thinnest axis on the side of the cameras that see it, each as much as it is worth in their
  // pictures (sum of blend weights); of one that none sees, away from the middle of the cloud.
  std::vector<vec3> normal;
  // Where it is seen: the mean of the surface (median depth) of the pixels that it is blended into, by their
  // weights. The middle of a Gaussian may lie under those before it, which would shadow it; of one that none
  // sees it is the middle.
  std::vector<vec3> position_m;
};
SeenSurface seenSurface(const GaussianCloud& cloud, std::span<const Camera> cameras, ComputeDevice& device,
                        Progress& progress);

struct BakeVisibilityOptions {
  int rays = 128;             // a Gaussian, stratified over the hemisphere of its normal
  double offset_m = 0.02;     // epsilon of the ray origin along the normal, BEAM 3.2
  double threshold = 0.9999;  // T of eq. 7
  std::uint64_t seed = 1;
};

// 1 channel, world axes, value(w) = 0.5 + sum_k Y_k(w) c_k: the share of light from w that arrives (methods
// 4.7), by least squares weighted with max(0, n.w) over the upper hemisphere and drawn weakly to the weighted
// mean, so that an open Gaussian has 1 in every direction. A plain projection of the open half space would be
// 0.81 straight above. Same bits for any number of threads.
ShBlock bakeVisibility(const GaussianCloud& cloud, const SeenSurface& surface,
                       const BakeVisibilityOptions& options, ComputeDevice& device, Progress& progress);

}  // namespace beam
