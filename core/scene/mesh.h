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
};

}  // namespace beam
