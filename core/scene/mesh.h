// SPDX-License-Identifier: Apache-2.0
// Triangles with shared vertices, in world axes, metres.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/types.h"

namespace beam {

struct Mesh {
  std::vector<vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  std::vector<vec3> normals = {};                       // unit, of each vertex; empty: none
  std::vector<vec2> uv = {};  // of each vertex, (0, 0) the upper left corner of a picture; empty: none
};

}  // namespace beam
