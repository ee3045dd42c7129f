// SPDX-License-Identifier: Apache-2.0
// Gradients through quaternions. A quaternion as a vector is (w, x, y, z).
#pragma once

#include "core/math/types.h"

namespace beam {

inline vec4 toVec4(quat q) { return {q.w, q.x, q.y, q.z}; }
inline quat toQuat(vec4 v) { return quat(v.x, v.y, v.z, v.w); }

// With L(q) given through its gradient at p = a q (or q a), a unit: the product's adjoint is the product with
// the conjugate.
inline vec4 throughLeftProduct(quat a, vec4 dp) { return toVec4(glm::conjugate(a) * toQuat(dp)); }
inline vec4 throughRightProduct(vec4 dp, quat a) { return toVec4(toQuat(dp) * glm::conjugate(a)); }

// dL/dq of L = g . R(q) v, q unit, up to a multiple of q (which normalising removes).
inline vec4 rotatedGradient(quat q, vec3 v, vec3 g) {
  const vec3 u(q.x, q.y, q.z);
  const float vg = glm::dot(v, g);
  const vec3 du =
      -2.0f * vg * u + 2.0f * glm::dot(u, g) * v + 2.0f * glm::dot(u, v) * g + 2.0f * q.w * glm::cross(v, g);
  return vec4(2.0f * q.w * vg + 2.0f * glm::dot(glm::cross(u, v), g), du);
}

// dL/dq from dL/d(q / |q|).
inline vec4 throughNormalize(quat q, vec4 d) {
  const vec4 v = toVec4(q);
  const float length = glm::length(v);
  const vec4 unit = v / length;
  return (d - glm::dot(d, unit) * unit) / length;
}

}  // namespace beam
