// SPDX-License-Identifier: Apache-2.0
// SSIM rows and Adam ranges, 16 floats at a time (methods 1.10, 1.11).
#define BEAM_KERNELS_SIMD
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/render/cpu/training_ops_simd.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include <algorithm>

#include "core/render/cpu/cpu_training_ops.h"
#include "core/render/kernels/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace beam {
namespace HWY_NAMESPACE {

alignas(64) constexpr float kIndex[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

// Blur at p[0 .. 16) across elements `step` apart.
HWY_INLINE Lanes blurAt(const SsimRows& s, const float* p, std::ptrdiff_t step) {
  Lanes r = Lanes(s.window[0]) * load(p);
  for (int i = 1; i <= kSsimReach; ++i)
    r = fma(Lanes(s.window[i]), load(p - i * step) + load(p + i * step), r);
  return r;
}

HWY_INLINE Mask insideRow(const SsimRows& s, int x) {
  return load(kIndex) < Lanes(static_cast<float>(s.width - x));
}

// Loads 16 pixels of an unpadded row; pixels behind its end are zero.
HWY_INLINE Lanes loadRow(const SsimRows& s, const float* row, int x) {
  if (x + 16 <= s.width) return load(row + x);
  alignas(64) float v[16] = {};
  std::copy_n(row + x, s.width - x, v);
  return load(v);
}

void blurProducts(const SsimRows& s, const float* a, const float* b, float* scratch, float* const* out) {
  float* rows[5];
  for (int i = 0; i < 5; ++i) rows[i] = scratch + static_cast<std::ptrdiff_t>(i) * s.stride + kSsimPad;
  for (int x = 0; x < s.width; x += 16) {
    const Lanes p = loadRow(s, a, x), q = loadRow(s, b, x);
    store(p, rows[0] + x), store(q, rows[1] + x);
    store(p * p, rows[2] + x), store(q * q, rows[3] + x), store(p * q, rows[4] + x);
  }
  for (int i = 0; i < 5; ++i) {
    for (int x = 0; x < s.width; x += 16) store(blurAt(s, rows[i] + x, 1), out[i] + x);
  }
}

double rowTerms(const SsimRows& s, const float* const* blurred, float* scratch, float* const* out) {
  const Lanes c1(1e-4f), c2(9e-4f), two(2.0f), one(1.0f);
  float* maps[3];
  for (int i = 0; i < 3; ++i) maps[i] = scratch + static_cast<std::ptrdiff_t>(i) * s.stride + kSsimPad;
  Lanes sum(0.0f);
  for (int x = 0; x < s.width; x += 16) {
    const Mask inside = insideRow(s, x);
    Lanes m[5];
    for (int i = 0; i < 5; ++i) m[i] = blurAt(s, blurred[i] + x, s.stride);
    const Lanes ma = m[0], mb = m[1];
    const Lanes a = fma(two * ma, mb, c1), b = fma(two, nfma(ma, mb, m[4]), c2);
    const Lanes c = fma(ma, ma, fma(mb, mb, c1)), d = nfma(ma, ma, m[2]) + nfma(mb, mb, m[3]) + c2;
    const Lanes ic = one / c, id = one / d, icd = ic * id;
    const Lanes ssim = a * b * icd, d_saa = -(ssim * id), d_sab = two * a * icd;
    sum = sum + keepIf(inside, ssim);
    const Lanes d_mean = two * mb * b * icd - two * ma * ssim * ic - two * ma * d_saa - mb * d_sab;
    store(keepIf(inside, d_mean), maps[0] + x);
    store(keepIf(inside, d_saa), maps[1] + x);
    store(keepIf(inside, d_sab), maps[2] + x);
  }
  for (int i = 0; i < 3; ++i) {
    for (int x = 0; x < s.width; x += 16) store(blurAt(s, maps[i] + x, 1), out[i] + x);
  }
  float total[4];
  sum4(sum, Lanes(0.0f), Lanes(0.0f), Lanes(0.0f), total);
  return total[0];
}

double gradientRow(const SsimRows& s, const float* const* maps, const float* a, const float* b,
                   float l1_scale, float ssim_scale, float* gradient) {
  Lanes sum(0.0f);
  const Lanes zero(0.0f), two(2.0f), l1(l1_scale), scale(ssim_scale);
  for (int x = 0; x < s.width; x += 16) {
    const Lanes p = loadRow(s, a, x), q = loadRow(s, b, x), difference = p - q;
    sum = sum + abs(difference);
    Lanes f[3];
    for (int i = 0; i < 3; ++i) f[i] = blurAt(s, maps[i] + x, s.stride);
    const Lanes sign = select(difference > zero, l1, select(difference < zero, -l1, zero));
    const Lanes g = fma(scale, fma(two * p, f[1], fma(q, f[2], f[0])), sign);
    if (x + 16 <= s.width) {
      store(g, gradient + x);
    } else {
      alignas(64) float v[16];
      store(g, v);
      std::copy_n(v, s.width - x, gradient + x);
    }
  }
  float total[4];
  sum4(sum, zero, zero, zero, total);
  return total[0];
}

void adamRange(const AdamRange& r) {
  const Lanes b1(r.beta1), b2(r.beta2), one(1.0f), epsilon(r.epsilon), rate(r.rate), root(r.inverse_root);
  const Lanes c1 = one - b1, c2 = one - b2, least(1e-30f);
  for (std::size_t i = 0; i < r.count; i += 16) {
    const Lanes g = load(r.gradient + i);
    Lanes m = fma(b1, load(r.first + i), c1 * g);
    m = keepIf(abs(m) > least, m);  // no denormals while a Gaussian is out of sight
    const Lanes v = fma(b2, load(r.second + i), c2 * (g * g));
    store(m, r.first + i);
    store(v, r.second + i);
    const Lanes step = rate * m / fma(sqrt(v), root, epsilon);
    store(load(r.parameter + i) - step, r.parameter + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace beam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beam {

HWY_EXPORT(blurProducts);
HWY_EXPORT(rowTerms);
HWY_EXPORT(gradientRow);
HWY_EXPORT(adamRange);

void ssimBlurProducts(const SsimRows& s, const float* a, const float* b, float* scratch,
                      float* const out[5]) {
  HWY_DYNAMIC_DISPATCH(blurProducts)(s, a, b, scratch, out);
}
double ssimRow(const SsimRows& s, const float* const blurred[5], float* scratch, float* const out[3]) {
  return HWY_DYNAMIC_DISPATCH(rowTerms)(s, blurred, scratch, out);
}
double ssimGradientRow(const SsimRows& s, const float* const maps[3], const float* a, const float* b,
                       float l1_scale, float ssim_scale, float* gradient) {
  return HWY_DYNAMIC_DISPATCH(gradientRow)(s, maps, a, b, l1_scale, ssim_scale, gradient);
}
void adamStep(const AdamRange& range) { HWY_DYNAMIC_DISPATCH(adamRange)(range); }

}  // namespace beam
#endif
