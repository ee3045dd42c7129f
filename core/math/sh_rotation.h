// SPDX-License-Identifier: Apache-2.0
// Turns spherical harmonics of sh.h with their Gaussian: value'(R d) = value(d), a matrix a band, since bands
// are closed under rotation.
#pragma once

#include "core/math/sh.h"
#include "core/math/types.h"

namespace beam {

class ShRotation {
 public:
  // `rotation`: proper. Quarter turns about the axes turn without rounding, the identity changes nothing.
  explicit ShRotation(const dmat3& rotation);
  // [k * channels + channel], kShCount of each; `out` may not be `in`.
  void apply(int channels, const float* in, float* out) const;

 private:
  double band_[4][7][7] = {};
};

}  // namespace beam
