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

constexpr int kReach = 5, kTaps = 11;
constexpr int kPad = 16;     // zeros on both sides of a row that is blurred along itself
constexpr int kMoments = 4;  // a, b, (a^2 + b^2) / 2, a b: the variances enter SSIM only as their sum
constexpr int kMaps = 3;     // dS/d mean, dS/d variance, dS/d covariance

std::ptrdiff_t lineFloats(int width) { return (width + 15) / 16 * 16; }

// Where a band keeps its rows. A ring holds the last 11 rows; all planes of a row lie side by side.
struct BandRows {
  const SsimChannel& c;
  std::ptrdiff_t line, padded;
  float *products, *moments, *maps, *zero;

  BandRows(const SsimChannel& channel, float* scratch)
      : c(channel), line(lineFloats(channel.width)), padded(line + 2 * kPad) {
    products = scratch;
    moments = products + kMoments * padded;
    maps = moments + kTaps * kMoments * line;
    zero = maps + kTaps * kMaps * line;
  }
  float* product(int plane) const { return products + plane * padded + kPad; }
  float* momentRow(int y) const { return moments + y % kTaps * kMoments * line; }
  float* mapRow(int y) const { return maps + y % kTaps * kMaps * line; }
  bool inside(int y) const { return y >= 0 && y < c.height; }
};

HWY_INLINE Lanes blurAlong(const float* window, const float* p) {
  Lanes r = Lanes(window[0]) * load(p);
  for (int i = 1; i <= kReach; ++i) r = fma(Lanes(window[i]), load(p - i) + load(p + i), r);
  return r;
}

// `rows`: the 11 rows around the one that is blurred.
HWY_INLINE Lanes blurAcross(const float* window, const float* const* rows, std::ptrdiff_t at) {
  Lanes r = Lanes(window[0]) * load(rows[kReach] + at);
  for (int i = 1; i <= kReach; ++i)
    r = fma(Lanes(window[i]), load(rows[kReach - i] + at) + load(rows[kReach + i] + at), r);
  return r;
}

HWY_INLINE Mask insideRow(int width, int x) { return load(kIndex) < Lanes(static_cast<float>(width - x)); }

// Loads 16 pixels of an unpadded row; pixels behind its end are zero.
HWY_INLINE Lanes loadRow(const float* row, int width, int x) {
  if (x + 16 <= width) return load(row + x);
  alignas(64) float v[16] = {};
  std::copy_n(row + x, width - x, v);
  return load(v);
}

HWY_INLINE void storeRow(Lanes value, float* row, int width, int x) {
  if (x + 16 <= width) return store(value, row + x);
  alignas(64) float v[16];
  store(value, v);
  std::copy_n(v, width - x, row + x);
}

HWY_INLINE double sumOfLanes(Lanes sum) {
  const Lanes zero(0.0f);
  float total[4];
  sum4(sum, zero, zero, zero, total);
  return total[0];
}

void momentsOfRow(const BandRows& b, int y) {
  const SsimChannel& c = b.c;
  const float *image = c.image + static_cast<std::ptrdiff_t>(y) * c.width,
              *target = c.target + static_cast<std::ptrdiff_t>(y) * c.width;
  for (int x = 0; x < c.width; x += 16) {
    const Lanes p = loadRow(image, c.width, x), q = loadRow(target, c.width, x);
    store(p, b.product(0) + x), store(q, b.product(1) + x);
    store(Lanes(0.5f) * (p * p + q * q), b.product(2) + x), store(p * q, b.product(3) + x);
  }
  float* out = b.momentRow(y);
  for (int i = 0; i < kMoments; ++i) {
    for (int x = 0; x < c.width; x += 16) store(blurAlong(c.window, b.product(i) + x), out + i * b.line + x);
  }
}

// SSIM of a row from the moments around it, and the maps of its derivatives, blurred along the row. Equal
// pictures give exactly 1. Returns the sum of SSIM.
double mapsOfRow(const BandRows& b, int y) {
  const SsimChannel& c = b.c;
  const float* rows[kTaps];
  for (int i = 0; i < kTaps; ++i) rows[i] = b.inside(y + i - kReach) ? b.momentRow(y + i - kReach) : b.zero;
  const Lanes c1(1e-4f), c2(9e-4f), two(2.0f), one(1.0f);
  Lanes sum(0.0f);
  for (int x = 0; x < c.width; x += 16) {
    Lanes m[kMoments];
    for (int i = 0; i < kMoments; ++i) m[i] = blurAcross(c.window, rows, i * b.line + x);
    const Lanes ma = m[0], mb = m[1];
    const Lanes a1 = fma(two * ma, mb, c1), a2 = fma(two, nfma(ma, mb, m[3]), c2);
    const Lanes b1 = fma(ma, ma, fma(mb, mb, c1)), b2 = nfma(ma, ma, m[2]) + nfma(mb, mb, m[2]) + c2;
    const Lanes inverse1 = one / b1, inverse2 = one / b2, inverse = inverse1 * inverse2;
    const Lanes ssim = a1 * a2 * inverse, by_variance = -(ssim * inverse2),
                by_covariance = two * a1 * inverse;
    const Lanes by_mean =
        two * mb * a2 * inverse - two * ma * ssim * inverse1 - two * ma * by_variance - mb * by_covariance;
    const Mask inside = insideRow(c.width, x);
    sum = sum + keepIf(inside, ssim);
    store(keepIf(inside, by_mean), b.product(0) + x);
    store(keepIf(inside, by_variance), b.product(1) + x);
    store(keepIf(inside, by_covariance), b.product(2) + x);
  }
  float* out = b.mapRow(y);
  for (int i = 0; i < kMaps; ++i) {
    for (int x = 0; x < c.width; x += 16) store(blurAlong(c.window, b.product(i) + x), out + i * b.line + x);
  }
  return sumOfLanes(sum);
}

// Returns the sum of |image - target|.
double gradientOfRow(const BandRows& b, int y) {
  const SsimChannel& c = b.c;
  const float* rows[kTaps];
  for (int i = 0; i < kTaps; ++i) rows[i] = b.inside(y + i - kReach) ? b.mapRow(y + i - kReach) : b.zero;
  const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(y) * c.width;
  const Lanes zero(0.0f), two(2.0f), l1(c.l1_scale), scale(c.ssim_scale);
  Lanes sum(0.0f);
  for (int x = 0; x < c.width; x += 16) {
    const Lanes p = loadRow(c.image + first, c.width, x), q = loadRow(c.target + first, c.width, x),
                difference = p - q;
    sum = sum + abs(difference);
    Lanes f[kMaps];
    for (int i = 0; i < kMaps; ++i) f[i] = blurAcross(c.window, rows, i * b.line + x);
    const Lanes sign = select(difference > zero, l1, select(difference < zero, -l1, zero));
    storeRow(fma(scale, fma(two * p, f[1], fma(q, f[2], f[0])), sign), c.gradient + first, c.width, x);
  }
  return sumOfLanes(sum);
}

void bandOf(const SsimChannel& channel, int begin, int end, float* scratch) {
  const BandRows b(channel, scratch);
  for (int y = std::max(0, begin - 2 * kReach); y < end + 2 * kReach; ++y) {
    if (b.inside(y)) momentsOfRow(b, y);
    const int map = y - kReach, out = y - 2 * kReach;
    if (b.inside(map) && map >= begin - kReach && map < end + kReach) {
      const double ssim = mapsOfRow(b, map);
      if (map >= begin && map < end) channel.row_ssim[map] = ssim;
    }
    if (out >= begin && out < end) channel.row_l1[out] = gradientOfRow(b, out);
  }
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

HWY_EXPORT(bandOf);
HWY_EXPORT(adamRange);

std::size_t ssimScratchFloats(int width) {
  using namespace HWY_NAMESPACE;  // NOLINT: its constants
  return static_cast<std::size_t>(kMoments * (lineFloats(width) + 2 * kPad) +
                                  (kTaps * (kMoments + kMaps) + kMoments) * lineFloats(width));
}
void ssimBand(const SsimChannel& channel, int begin, int end, float* scratch) {
  HWY_DYNAMIC_DISPATCH(bandOf)(channel, begin, end, scratch);
}
void adamStep(const AdamRange& range) { HWY_DYNAMIC_DISPATCH(adamRange)(range); }

}  // namespace beam
#endif
