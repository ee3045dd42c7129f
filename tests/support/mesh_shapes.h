// SPDX-License-Identifier: Apache-2.0
// Meshes of which closed forms are known.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "core/scene/render_scene.h"

namespace beam::testing {

// An icosahedron whose edges were halved `times` times, with the normals of the sphere.
inline Mesh icosphere(vec3 center, float radius_m, int times) {
  const float g = 1.6180340f;
  Mesh m;
  for (const float a : {-1.0f, 1.0f}) {
    for (const float b : {-g, g}) {
      for (const vec3& v : {vec3(a, b, 0), vec3(0, a, b), vec3(b, 0, a)})
        m.normals.push_back(glm::normalize(v));
    }
  }
  // Faces: corners that are next to each other, turned outwards.
  for (std::uint32_t i = 0; i < 12; ++i) {
    for (std::uint32_t j = i + 1; j < 12; ++j) {
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        const vec3 a = m.normals[i], b = m.normals[j], c = m.normals[k];
        if (glm::dot(a, b) < 0.4f || glm::dot(b, c) < 0.4f || glm::dot(c, a) < 0.4f) continue;
        const bool outwards = glm::dot(glm::cross(b - a, c - a), a) > 0;
        m.triangles.push_back({i, outwards ? j : k, outwards ? k : j});
      }
    }
  }
  for (int t = 0; t < times; ++t) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t i, std::uint32_t j) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(i, j), m.normals.size());
      if (fresh) m.normals.push_back(glm::normalize(m.normals[i] + m.normals[j]));
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [i, j, k] : m.triangles) {
      const std::uint32_t a = middle(i, j), b = middle(j, k), c = middle(k, i);
      finer.insert(finer.end(), {{i, a, c}, {a, j, b}, {c, b, k}, {a, b, c}});
    }
    m.triangles = std::move(finer);
  }
  for (const vec3& n : m.normals) m.vertices.push_back(center + radius_m * n);
  return m;
}

// The rectangle center + s a + t b, s and t in [-1, 1]; uv from (0, 0) at center - a - b to (1, 1).
inline Mesh rectangle(vec3 center, vec3 a, vec3 b) {
  return {.vertices = {center - a - b, center + a - b, center + a + b, center - a + b},
          .triangles = {{0, 1, 2}, {0, 2, 3}},
          .uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
}

inline RenderMesh meshOf(Mesh mesh, vec3 base_color, float roughness = 0.5f) {
  RenderMesh m;
  m.mesh = std::make_shared<const Mesh>(std::move(mesh));
  m.base_color = base_color;
  m.roughness = roughness;
  return m;
}

}  // namespace beam::testing
