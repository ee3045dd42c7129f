// SPDX-License-Identifier: Apache-2.0
#include "core/math/sh_rotation.h"

#include <cmath>

namespace beam {
namespace {

// Solved from sample directions, exact to rounding.
void solveBand(int l, const dmat3& rotation, double (&out)[7][7]) {
  const int n = 2 * l + 1, first = l * l;
  double a[7][14] = {};
  // Normal equations over well-spread directions: B(R d)^T B(R d) X = B(R d)^T B(d).
  constexpr int kDirections = 64;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z), phi = 2.399963229728653 * i;
    const dvec3 d(r * std::cos(phi), r * std::sin(phi), z);
    const auto from = shBasis(vec3(d)), to = shBasis(vec3(rotation * d));
    for (int p = 0; p < n; ++p) {
      for (int q = 0; q < n; ++q) {
        a[p][q] += double(to[first + p]) * to[first + q];
        a[p][n + q] += double(to[first + p]) * from[first + q];
      }
    }
  }
  for (int p = 0; p < n; ++p) {  // Gauss-Jordan; the matrix is well conditioned
    const double pivot = a[p][p];
    for (int q = 0; q < 2 * n; ++q) a[p][q] /= pivot;
    for (int r = 0; r < n; ++r) {
      if (r == p) continue;
      const double f = a[r][p];
      for (int q = 0; q < 2 * n; ++q) a[r][q] -= f * a[p][q];
    }
  }
  for (int p = 0; p < n; ++p) {
    for (int q = 0; q < n; ++q) {
      const double v = a[p][n + q];
      // Signed permutations give whole numbers and halves of roots; only rounding noise around 0 and 1 is
      // cleaned.
      out[p][q] = std::abs(v) < 1e-6 ? 0 : std::abs(std::abs(v) - 1) < 1e-6 ? std::copysign(1.0, v) : v;
    }
  }
}

}  // namespace

ShRotation::ShRotation(const dmat3& rotation) {
  for (int l = 1; l <= 3; ++l) solveBand(l, rotation, band_[l]);
}

void ShRotation::apply(int channels, const float* in, float* out) const {
  for (int c = 0; c < channels; ++c) out[c] = in[c];
  for (int l = 1; l <= 3; ++l) {
    for (int p = 0; p < 2 * l + 1; ++p) {
      for (int c = 0; c < channels; ++c) {
        double sum = 0;
        for (int q = 0; q < 2 * l + 1; ++q) sum += band_[l][p][q] * in[(l * l + q) * channels + c];
        out[(l * l + p) * channels + c] = static_cast<float>(sum);
      }
    }
  }
}

}  // namespace beam
