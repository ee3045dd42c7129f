// SPDX-License-Identifier: Apache-2.0
// Surfaces made of dense, flat, nearly opaque Gaussians (methods 11.2): the closed forms of geometry and
// occlusion hold on them.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/rng.h"
#include "core/math/sampling.h"
#include "core/scene/gaussian_cloud.h"

namespace beam::testing {

inline quat facing(vec3 normal) {
  const Frame3 f(normal);
  return glm::normalize(glm::quat_cast(mat3(f.tangent, f.bitangent, f.normal)));
}

inline void addSplat(GaussianCloud& cloud, vec3 position, vec3 normal, float sigma_m, float thickness_m) {
  cloud.position_m.push_back(position);
  cloud.rotation.push_back(facing(normal));
  cloud.scale_m.push_back({sigma_m, sigma_m, thickness_m});
  cloud.opacity.push_back(0.95f);
  cloud.color.coefficients.resize(cloud.size() * kShCount * 3, 0.0f);
}

// The rectangle center + a u + b v, u and v in [-1, 1]; one splat every `spacing_m`, of one sigma.
inline void addRectangle(GaussianCloud& cloud, vec3 center, vec3 a, vec3 b, float spacing_m) {
  const int nu = static_cast<int>(std::ceil(2 * glm::length(a) / spacing_m));
  const int nv = static_cast<int>(std::ceil(2 * glm::length(b) / spacing_m));
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const float u = 2.0f * i / nu - 1, v = 2.0f * j / nv - 1;
      addSplat(cloud, center + u * a + v * b, glm::normalize(glm::cross(a, b)), spacing_m, 0.001f);
    }
  }
}

// Fibonacci sphere.
inline void addSphere(GaussianCloud& cloud, vec3 center, float radius_m, int count) {
  const float spacing = radius_m * std::sqrt(4 * kPi / count);
  for (int i = 0; i < count; ++i) {
    const float y = 1 - (2 * i + 1.0f) / count, r = std::sqrt(1 - y * y), phi = 2.39996323f * i;
    const vec3 n(r * std::cos(phi), y, r * std::sin(phi));
    addSplat(cloud, center + radius_m * n, glm::normalize(n), spacing, 0.1f * spacing);
  }
}

inline void fillRandom(std::vector<float>& values, std::uint64_t stream, float size) {
  const RandomStream random(stream);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = size * random.normal(i);
}

// SH of the given size around grey and half occluded; two streams.
inline std::shared_ptr<Materials> randomMaterials(std::size_t count, std::uint64_t stream, float size,
                                                  float roughness) {
  auto materials = std::make_shared<Materials>();
  materials->roughness.assign(count, roughness);
  materials->base_color = ShBlock(count, 3);
  materials->ambient_occlusion = ShBlock(count, 1);
  fillRandom(materials->base_color.coefficients, stream, size);
  fillRandom(materials->ambient_occlusion.coefficients, stream + 1, size);
  return materials;
}

}  // namespace beam::testing
