// SPDX-License-Identifier: Apache-2.0
// Similarity3: x_in_a = a_from_b * x_in_b = scale * rotation * x_in_b + translation. The rotation is a
// matrix, so that a turn between axes is carried out without rounding.
#pragma once

#include "core/math/types.h"

namespace beam {

struct Similarity3 {
  dmat3 rotation = dmat3(1.0);  // proper
  double scale = 1;             // > 0; lengths in a for one of b
  dvec3 translation = dvec3(0);

  bool operator==(const Similarity3&) const = default;
};

// Neither scales nor moves.
inline bool isTurn(const Similarity3& s) { return s.scale == 1 && s.translation == dvec3(0); }
inline bool isIdentity(const Similarity3& s) { return s == Similarity3{}; }

// A pure turn between axes only exchanges and negates coordinates.
inline dvec3 operator*(const Similarity3& a_from_b, const dvec3& x_in_b) {
  const dvec3 turned = a_from_b.rotation * x_in_b;
  return isTurn(a_from_b) ? turned : a_from_b.scale * turned + a_from_b.translation;
}
inline Similarity3 operator*(const Similarity3& a_from_b, const Similarity3& b_from_c) {
  return {a_from_b.rotation * b_from_c.rotation, a_from_b.scale * b_from_c.scale,
          a_from_b * b_from_c.translation};
}
inline Similarity3 inverse(const Similarity3& a_from_b) {
  const dmat3 turn = glm::transpose(a_from_b.rotation);
  const double scale = 1 / a_from_b.scale;
  if (isTurn(a_from_b)) return {turn, 1, dvec3(0)};
  return {turn, scale, -scale * (turn * a_from_b.translation)};
}

}  // namespace beam
