// SPDX-License-Identifier: Apache-2.0
// The capsule man: a figure 1.75 m tall (feet at 0, +Y up, looking along +Z) as a cloud of flat Gaussians on
// its outer surface, a camera that sees all of it, and ambient-occlusion rays off its skin. For benchmarks
// and tests that need a cloud of real size; deterministic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/render/tracer.h"
#include "core/scene/camera.h"
#include "core/scene/gaussian_cloud.h"

namespace beam::testing {

struct CapsulePoint {
  vec3 position, normal;
  int part;
};
// Uniform on the outer surface.
std::vector<CapsulePoint> capsulePoints(std::size_t count, std::uint64_t seed);

// `sigma_m`: median standard deviation of the two larger axes at 140,000 Gaussians, growing with 1 /
// sqrt(count) so that coverage stays; the thin axis has a sixth of it. Sizes are log-normal with 25 %,
// opacities lie in [0.5, 0.99).
GaussianCloud capsuleCloud(std::size_t count, float sigma_m = 0.006f);

// From the front, 3 m away; the figure fills 85 % of the height.
Camera capsuleCamera(int width, int height);

// `rays_per_point` cosine-distributed directions from surface points, `offset_m` off the surface.
std::vector<Ray> capsuleRays(std::size_t points, int rays_per_point, float offset_m);

}  // namespace beam::testing
