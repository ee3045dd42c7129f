// SPDX-License-Identifier: Apache-2.0
// Spherical harmonics of degree 0 to 3 and their gradients by direction, as polynomials (methods 1.2, 1.9).
// Include like lanes.h.
#include "core/render/kernels/project.h"

#ifdef BEAM_KERNELS_SIMD
#if defined(BEAM_SH_KERNEL_TOGGLE) == defined(HWY_TARGET_TOGGLE)
#ifdef BEAM_SH_KERNEL_TOGGLE
#undef BEAM_SH_KERNEL_TOGGLE
#else
#define BEAM_SH_KERNEL_TOGGLE
#endif
#define BEAM_KERNELS_READ
#endif
#elif !defined(BEAM_SH_KERNEL_ONCE)
#define BEAM_SH_KERNEL_ONCE
#define BEAM_KERNELS_READ
#endif

#ifdef BEAM_KERNELS_READ
#undef BEAM_KERNELS_READ
BEAM_KERNELS_BEGIN

template <class F>
BEAM_INLINE void shBasisOf(const Vec3<F>& d, int degree, F* b) {
  const F x = d.x, y = d.y, z = d.z;
  b[0] = F(0.28209479f);
  if (degree < 1) return;
  const F c1(0.48860251f);
  b[1] = -c1 * y, b[2] = c1 * z, b[3] = -c1 * x;
  if (degree < 2) return;
  const F xx = x * x, yy = y * y, zz = z * z;
  b[4] = F(1.09254843f) * x * y;
  b[5] = F(-1.09254843f) * y * z;
  b[6] = F(0.31539157f) * (F(2.0f) * zz - xx - yy);
  b[7] = F(-1.09254843f) * x * z;
  b[8] = F(0.54627422f) * (xx - yy);
  if (degree < 3) return;
  b[9] = F(-0.59004359f) * y * (F(3.0f) * xx - yy);
  b[10] = F(2.89061144f) * x * y * z;
  b[11] = F(-0.45704580f) * y * (F(4.0f) * zz - xx - yy);
  b[12] = F(0.37317633f) * z * (F(2.0f) * zz - F(3.0f) * xx - F(3.0f) * yy);
  b[13] = F(-0.45704580f) * x * (F(4.0f) * zz - xx - yy);
  b[14] = F(1.44530572f) * z * (xx - yy);
  b[15] = F(-0.59004359f) * x * (xx - F(3.0f) * yy);
}

// Sum over k of grad basis_k * u[k], for u given from k = 1.
template <class F>
BEAM_INLINE Vec3<F> shDirectionGradient(const Vec3<F>& d, int degree, const F* u) {
  const F x = d.x, y = d.y, z = d.z, zero(0.0f), two(2.0f), three(3.0f), four(4.0f), six(6.0f);
  if (degree < 1) return {zero, zero, zero};
  const F c1(0.48860251f);
  Vec3<F> g = {-c1 * u[3], -c1 * u[1], c1 * u[2]};
  if (degree < 2) return g;
  const F k4(1.09254843f), k6(0.31539157f), k8(0.54627422f);
  g.x = g.x + k4 * (y * u[4] - z * u[7]) - two * k6 * x * u[6] + two * k8 * x * u[8];
  g.y = g.y + k4 * (x * u[4] - z * u[5]) - two * k6 * y * u[6] - two * k8 * y * u[8];
  g.z = g.z - k4 * (y * u[5] + x * u[7]) + four * k6 * z * u[6];
  if (degree < 3) return g;
  const F xx = x * x, yy = y * y, zz = z * z, k9(-0.59004359f), k10(2.89061144f), k11(-0.45704580f),
          k12(0.37317633f), k14(1.44530572f);
  g.x = g.x + k9 * six * x * y * u[9] + k10 * y * z * u[10] - k11 * two * x * y * u[11] -
        k12 * six * x * z * u[12] + k11 * (four * zz - three * xx - yy) * u[13] + k14 * two * x * z * u[14] +
        k9 * three * (xx - yy) * u[15];
  g.y = g.y + k9 * three * (xx - yy) * u[9] + k10 * x * z * u[10] +
        k11 * (four * zz - xx - three * yy) * u[11] - k12 * six * y * z * u[12] - k11 * two * x * y * u[13] -
        k14 * two * y * z * u[14] - k9 * six * x * y * u[15];
  g.z = g.z + k10 * x * y * u[10] + k11 * F(8.0f) * y * z * u[11] +
        k12 * (six * zz - three * xx - three * yy) * u[12] + k11 * F(8.0f) * x * z * u[13] +
        k14 * (xx - yy) * u[14];
  return g;
}

BEAM_KERNELS_END
#endif
