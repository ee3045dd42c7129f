// SPDX-License-Identifier: Apache-2.0
#include "viewers/scene/coarse_mesh.h"

#include <cmath>
#include <unordered_map>

namespace beam {
namespace {

double areaOf(const Mesh& mesh) {
  double twice = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    twice +=
        glm::length(glm::cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
  return 0.5 * twice;
}

// 21 bits an axis; cells further out than that share one, which a stand-in can bear.
std::uint64_t cellOf(vec3 vertex, float cell_m) {
  constexpr float kMost = 1 << 20;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float at = glm::clamp(std::floor(vertex[axis] / cell_m), -kMost, kMost - 1);
    key = key << 21 | static_cast<std::uint64_t>(static_cast<std::int64_t>(at) + (1 << 20));
  }
  return key;
}

Mesh clustered(const Mesh& mesh, float cell_m) {
  Mesh coarse;
  std::unordered_map<std::uint64_t, std::uint32_t> clusters;
  std::vector<std::uint32_t> cluster_of;
  std::vector<float> counts;
  cluster_of.reserve(mesh.vertices.size());
  for (const vec3& vertex : mesh.vertices) {
    const auto [it, fresh] =
        clusters.try_emplace(cellOf(vertex, cell_m), static_cast<std::uint32_t>(counts.size()));
    if (fresh) {
      coarse.vertices.emplace_back(0);
      counts.push_back(0);
    }
    coarse.vertices[it->second] += vertex;
    counts[it->second] += 1;
    cluster_of.push_back(it->second);
  }
  for (std::size_t i = 0; i < counts.size(); ++i) coarse.vertices[i] /= counts[i];
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<std::uint32_t, 3> t{cluster_of[a], cluster_of[b], cluster_of[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) coarse.triangles.push_back(t);
  }
  return coarse;
}

}  // namespace

Mesh coarser(const Mesh& mesh, std::size_t most_triangles) {
  if (mesh.triangles.size() <= most_triangles) return mesh;
  // Triangles of an even net with edges of one cell: 4 / sqrt(3) an area of a cell.
  constexpr double kTrianglesPerCell = 2.3;
  auto cell_m =
      static_cast<float>(std::sqrt(kTrianglesPerCell * areaOf(mesh) / static_cast<double>(most_triangles)));
  for (; std::isfinite(cell_m) && cell_m > 0; cell_m *= 1.25f) {
    Mesh coarse = clustered(mesh, cell_m);
    if (coarse.triangles.size() <= most_triangles) return coarse;
  }
  return {};  // without area, or not of this world: nothing to see in either
}

}  // namespace beam
