// SPDX-License-Identifier: Apache-2.0
// What light reaches a surface point past the Gaussians: the integrals L_D, L_S (BEAM eq. 5, 6) and A (eq.
// 3), all from one set of shadow rays (methods 5.3, 5.4).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/render/tracer.h"
#include "core/scene/camera.h"
#include "core/scene/environment.h"
#include "core/scene/gbuffer.h"

namespace beam {

// A point on the visible surface of a view.
struct SurfacePoint {
  std::int32_t x = 0, y = 0;  // pixel
  vec3 position_m;            // world, from the median depth
  vec3 normal;                // unit, world
  vec3 to_eye;                // unit
};

// The pixels worth tracing (methods 5.1): inside the mask where there is one, alpha > 0.9, n.wo > 0.05, no
// depth edge.
std::vector<SurfacePoint> surfacePoints(const GBuffer& gbuffer, const Camera& camera,
                                        const Image<std::uint8_t>& mask);

struct LightIntegrals {
  vec3 diffuse;   // L_D = 1/pi * integral of (1 - F) V L (n.w)
  vec3 specular;  // L_S = integral of f_s V L (n.w)
  float sky = 0;  // A = 1/pi * integral of V (n.w)
  vec3 variance;  // of luminance(L_D), luminance(L_S) and A, from two half sets of rays
};

struct LightSampling {
  int cosine = 50, environment = 40, specular = 20;  // rays a point by strategy
  float offset_m = 0.02f;                            // of the ray's origin along the normal
  float roughness = 0.6f;
  std::uint64_t seed = 1;  // of this view
};

// One entry a point, in their order. Multiple importance sampling with the balance heuristic; blocks of 4x4
// pixels share one low-discrepancy sequence. Steps `progress` by the number of points.
std::vector<LightIntegrals> integrateLight(std::span<const SurfacePoint> points,
                                           const LightSampling& sampling,
                                           const EnvironmentSampler& environment, const Tracer& tracer,
                                           Progress& progress);

}  // namespace beam
