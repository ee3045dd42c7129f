// SPDX-License-Identifier: Apache-2.0
// Visibility along rays through Gaussians (BEAM eq. 7, methods 4.2-4.3): every Gaussian counts once, at its
// maximum response along the ray; alphas are summed without order, in fixed point, and a ray stops at the
// threshold.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/scene/gaussian_cloud.h"

namespace beam {

struct TracerDesc {
  float threshold = 0.9999f;      // T: blocked if and only if the sum of alphas exceeds it (eq. 7)
  float cut_response = 0.0113f;   // kernel ends where opacity * response falls below (3DGRT: 0.0113)
  bool ignore_containing = true;  // Gaussians whose cut ellipsoid holds the origin do not count (methods 4.3)
};

struct Ray {
  vec3 origin;     // metres, world
  vec3 direction;  // unit
};

class Tracer {
 public:
  virtual ~Tracer() = default;
  // blocked[i] = 1 when ray i is occluded, else 0. Same bits for any number of threads and any order of
  // Gaussians.
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const = 0;
  // The unthresholded sum of alphas of one ray, in units of 2^-20 (for tests).
  virtual std::uint64_t alphaSum(const Ray& ray) const = 0;
  virtual std::size_t memoryBytes() const = 0;
};

}  // namespace beam
