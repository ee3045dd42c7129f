// SPDX-License-Identifier: Apache-2.0
// Points in the unit square and directions made of them: for every Monte Carlo integral of the house.
// Local frames have the normal along +Z.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/math/types.h"

namespace beam {

// Orthonormal frame around a unit normal, without a branch (Duff et al. 2017).
struct Frame3 {
  vec3 tangent, bitangent, normal;

  explicit Frame3(vec3 n) : normal(n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1 / (sign + n.z), b = n.x * n.y * a;
    tangent = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
  }
  vec3 toWorld(vec3 v) const { return v.x * tangent + v.y * bitangent + v.z * normal; }
  vec3 toLocal(vec3 v) const { return {glm::dot(v, tangent), glm::dot(v, bitangent), glm::dot(v, normal)}; }
};

// R2 low-discrepancy sequence (Roberts 2018), turned by a start point (Cranley-Patterson). Any run of
// consecutive points is as even as the first ones, so neighbours that take consecutive runs are even
// together.
struct R2Sequence {
  std::uint32_t x = 0, y = 0;  // start, in units of 2^-32

  vec2 operator()(std::uint32_t i) const {
    // Steps 1/g and 1/g^2 of g^3 = g + 1, in units of 2^-32: the arithmetic is exact for every index.
    const std::uint32_t u = x + i * 3242174889u, v = y + i * 2447445414u;
    return {static_cast<float>(u >> 8) * 0x1p-24f, static_cast<float>(v >> 8) * 0x1p-24f};
  }
};

// Density cos / pi about +Z, by the concentric map (Shirley and Chiu 1997).
inline vec3 cosineDirection(vec2 u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0, 1};
  const bool wide = std::abs(a) > std::abs(b);
  const float r = wide ? a : b;
  const float phi = wide ? kPi / 4 * (b / a) : kPi / 2 - kPi / 4 * (a / b);
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - r * r))};
}

// Half vector drawn from the GGX normals that are visible from `view` (local, z > 0), by the spherical cap
// (Dupuy and Benyoub 2023). Its density in the reflected direction is Reflectance::reflection_pdf
// (core/math/brdf.h).
inline vec3 visibleNormal(vec3 view, float alpha, vec2 u) {
  const vec3 v = glm::normalize(vec3(alpha * view.x, alpha * view.y, view.z));
  const float phi = 2 * kPi * u.x, z = (1 - u.y) * (1 + v.z) - v.z;
  const float s = std::sqrt(std::clamp(1 - z * z, 0.0f, 1.0f));
  const vec3 h = vec3(s * std::cos(phi), s * std::sin(phi), z) + v;
  return glm::normalize(vec3(alpha * h.x, alpha * h.y, std::max(0.0f, h.z)));
}

}  // namespace beam
