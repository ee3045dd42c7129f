// SPDX-License-Identifier: Apache-2.0
// Real spherical harmonics to degree 3 in the splat dialect (methods 1.2): 16 functions, Condon-Shortley
// signs, value = 0.5 + sum_k basis_k(direction) * coefficient_k. Direction: unit, from the camera to the
// Gaussian, world axes.
#pragma once

#include <array>

#include "core/math/types.h"

namespace beam {

inline constexpr int kShCount = 16;
inline constexpr float kShC0 = 0.28209479177387814f;
inline constexpr float kShC1 = 0.4886025119029199f;

inline constexpr int shCount(int degree) { return (degree + 1) * (degree + 1); }

inline std::array<float, kShCount> shBasis(vec3 d) {
  const float x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
  return {kShC0,
          -kShC1 * y,
          kShC1 * z,
          -kShC1 * x,
          1.0925484305920792f * x * y,
          -1.0925484305920792f * y * z,
          0.31539156525252005f * (2 * zz - xx - yy),
          -1.0925484305920792f * x * z,
          0.5462742152960396f * (xx - yy),
          -0.5900435899266435f * y * (3 * xx - yy),
          2.890611442640554f * x * y * z,
          -0.4570457994644658f * y * (4 * zz - xx - yy),
          0.3731763325901154f * z * (2 * zz - 3 * xx - 3 * yy),
          -0.4570457994644658f * x * (4 * zz - xx - yy),
          1.445305721320277f * z * (xx - yy),
          -0.5900435899266435f * x * (xx - 3 * yy)};
}

}  // namespace beam
