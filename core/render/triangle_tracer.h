// SPDX-License-Identifier: Apache-2.0
// Rays among triangle meshes, by Embree: what is met first, and whether anything is in the way. World axes,
// metres. Serves any number of threads, the same hits for all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/scene/mesh.h"

namespace beam {

struct TriangleHit {
  std::uint32_t mesh = 0, triangle = 0;  // places in the list, and in the mesh
  vec2 weights{0};                       // of the second and third corner; the first one has the rest
  float distance_m = 0;                  // along the ray
  vec3 normal{0, 1, 0};  // of the triangle, unit; corners run counter-clockwise seen from there
};

// Closed: nothing slips through the edge between two triangles. Rounded: it may, and hits differ in their
// last bits; for who keeps what it once gave.
enum class TriangleEdges { Closed, Rounded };

class TriangleTracer {
 public:
  // Copies what it needs; none, or none with triangles, is fine. Throws Error{Data} for a triangle that names
  // a vertex which is not there and for a vertex that is not finite.
  explicit TriangleTracer(std::span<const Mesh> meshes, TriangleEdges edges = TriangleEdges::Closed);
  ~TriangleTracer();
  TriangleTracer(TriangleTracer&&) noexcept;
  TriangleTracer& operator=(TriangleTracer&&) noexcept;
  // Other places of a mesh's vertices, as many and finite. Nobody may trace meanwhile.
  void move(std::uint32_t mesh, std::span<const vec3> vertices);

  // Within `reach_m`, from either side; `direction` is unit.
  std::optional<TriangleHit> nearest(vec3 origin_m, vec3 direction, float reach_m) const;
  bool occluded(vec3 origin_m, vec3 direction, float reach_m) const;
  std::size_t memoryBytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beam
