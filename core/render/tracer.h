// SPDX-License-Identifier: Apache-2.0
// Visibility along rays through Gaussians (BEAM eq. 7, methods 4.2-4.3): every Gaussian counts once, at its
// maximum response along the ray; alphas are summed without order, in fixed point, and a ray stops at the
// threshold.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
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

// Where a ray ends.
struct SplatHit {
  std::uint32_t splat = 0;  // index in the cloud
  float distance_m = 0;     // to its maximum response along the ray
};

inline constexpr float kMostAlpha = 0.99f;  // of one Gaussian where they are blended (methods 4.3)
inline constexpr float kEndless_m = std::numeric_limits<float>::infinity();

// What of a ray counts where Gaussians are blended along it: what lies ahead and nearer, as TracerDesc says
// of those that hold the origin.
struct BlendRules {
  float reach_m = kEndless_m;
  // Of the cloud's Gaussians, unit; null: unknown. With them those do not count that the ray leaves from
  // behind, n.d > 0: the surface that it starts from is no sheet but as thick as they are.
  const vec3* outward = nullptr;

  bool counts(std::uint32_t splat, vec3 direction) const {
    return outward == nullptr || glm::dot(outward[splat], direction) <= 0;
  }
};

class Tracer {
 public:
  virtual ~Tracer() = default;
  // blocked[i] = 1 when ray i is occluded, else 0. Same bits for any number of threads and any order of
  // Gaussians.
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const = 0;
  // Light that gets through: the product of 1 - alpha of what counts, each alpha at most kMostAlpha (ordered
  // blending, whatever the order); 0 where less than 1/1024 does.
  virtual float transmittance(const Ray& ray, const BlendRules& rules = {}) const = 0;
  // The Gaussian in which a ray ends that each one stops with the probability of its alpha, in order of their
  // maxima; none: it gets through. `draw` is the ray's chance: the same one ends in the same. Over draws it
  // ends in each as often as that one's blend weight.
  virtual std::optional<SplatHit> drawn(const Ray& ray, std::uint64_t draw,
                                        const BlendRules& rules = {}) const = 0;
  // The unthresholded sum of alphas of one ray, in units of 2^-20 (for tests).
  virtual std::uint64_t alphaSum(const Ray& ray) const = 0;
  virtual std::size_t memoryBytes() const = 0;
};

}  // namespace beam
