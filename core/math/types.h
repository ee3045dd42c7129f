// SPDX-License-Identifier: Apache-2.0
// The GLM types that the house uses, under one name each. Matrices are column-major as in GLM:
// m[column][row]. Quaternions are written w x y z: quat(w, x, y, z).
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstdint>

namespace beam {

using glm::dmat2;
using glm::dmat3;
using glm::dmat4;
using glm::dquat;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;
using glm::ivec3;
using glm::mat3;
using glm::mat4;
using glm::quat;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using u8vec3 = glm::vec<3, std::uint8_t>;
using u8vec4 = glm::vec<4, std::uint8_t>;

inline constexpr float kPi = 3.14159265358979323846f;

}  // namespace beam
