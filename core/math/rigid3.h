// SPDX-License-Identifier: Apache-2.0
// Rigid3: x_in_a = a_from_b * x_in_b. Double precision; the pixels of 4K cameras need it.
#pragma once

#include "core/math/types.h"

namespace beam {

struct Rigid3 {
  dquat rotation = dquat(1, 0, 0, 0);  // unit
  dvec3 translation_m = dvec3(0);

  bool operator==(const Rigid3&) const = default;
};

inline dvec3 operator*(const Rigid3& a_from_b, const dvec3& x_in_b) {
  return a_from_b.rotation * x_in_b + a_from_b.translation_m;
}
inline Rigid3 operator*(const Rigid3& a_from_b, const Rigid3& b_from_c) {
  return {glm::normalize(a_from_b.rotation * b_from_c.rotation), a_from_b * b_from_c.translation_m};
}
inline Rigid3 inverse(const Rigid3& a_from_b) {
  const dquat q = glm::conjugate(a_from_b.rotation);
  return {q, -(q * a_from_b.translation_m)};
}

}  // namespace beam
