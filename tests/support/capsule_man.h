// SPDX-License-Identifier: Apache-2.0
// The capsule man: a figure 1.75 m tall (feet at 0, +Y up, looking along +Z) as a cloud of flat Gaussians on
// its outer surface, a camera that sees all of it, and ambient-occlusion rays off its skin. For benchmarks
// and tests that need a cloud of real size; deterministic.
#pragma once

#include <cstddef>
#include <vector>

#include "core/render/tracer.h"
#include "core/scene/camera.h"
#include "core/scene/gaussian_cloud.h"

namespace beam::testing {

// `sigma_mm`: median standard deviation of the two larger axes at 140,000 Gaussians; it grows with
// 1 / sqrt(count), so that coverage stays. Sizes are log-normal with 25 %, opacities lie in [0.5, 0.99).
struct CapsuleManSizes {
  float sigma_mm = 6;
  float thin_mm = 1;
};
GaussianCloud capsuleMan(std::size_t count, const CapsuleManSizes& sizes = {});

// From the front, 3 m away; the figure fills 85 % of the height.
Camera capsuleManCamera(int width, int height);

// `rays_per_point` cosine-distributed directions from `points` surface points, `offset_m` off the surface.
std::vector<Ray> capsuleManRays(int points, int rays_per_point, float offset_m);

}  // namespace beam::testing
