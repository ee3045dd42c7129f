// SPDX-License-Identifier: Apache-2.0
// Gaussians into a light's view, and their ellipses over its texels, 16 at a time.
#define BEAM_KERNELS_SIMD
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/render/cpu/shadow_simd.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include <algorithm>
#include <cmath>

#include "core/render/cpu/cpu_shadow_drawer.h"
#include "core/render/kernels/project.h"
#include "core/render/tracer.h"

HWY_BEFORE_NAMESPACE();
namespace beam {
namespace HWY_NAMESPACE {

// Added to the variances, texels^2: a Gaussian that is smaller than a texel must not fall between them.
constexpr float kShadowDilation = 0.3f;
constexpr float kOffAxis = 1.3f;  // of the half width: ratios in the Jacobian stay below (methods 1.3)

HWY_INLINE Vec3<Lanes> lanesOf(vec3 v) { return {Lanes(v.x), Lanes(v.y), Lanes(v.z)}; }

HWY_INLINE Vec3<Lanes> times(const Vec3<Lanes>& a, const Vec3<Lanes>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

// thinAxis (scene/thin_axis.h) of a rotation's columns.
HWY_INLINE Vec3<Lanes> thinColumn(const Mat3<Lanes>& r, const Vec3<Lanes>& scale) {
  const Mask x = (scale.x <= scale.y) & (scale.x <= scale.z), y = scale.y <= scale.z;
  const auto of = [&](const Vec3<Lanes>& row) HWY_ATTR { return select(x, row.x, select(y, row.y, row.z)); };
  return {of(r.r[0]), of(r.r[1]), of(r.r[2])};
}

// The rest of a splat is scalar: logarithms, and what is not drawn at all.
struct CastLanes {
  alignas(64) float x[16], y[16], a[16], b[16], c[16], z[16], slope_x[16], slope_y[16], var_x[16], var_y[16];
};

HWY_INLINE unsigned castLanes(const GaussianBuffers& g, const float* side, const ShadowView& view,
                              std::size_t i, CastLanes& out) {
  using L = PlaneLayout;
  const auto at = [&](int plane) HWY_ATTR { return load(g.plane(plane) + i); };
  const mat3& w = view.world_from_light;
  const Mat3<Lanes> light_from_world = {{lanesOf(w[0]), lanesOf(w[1]), lanesOf(w[2])}};
  const Vec3<Lanes> position = {at(L::kPosition), at(L::kPosition + 1), at(L::kPosition + 2)};
  const Vec3<Lanes> scale = {at(L::kScale), at(L::kScale + 1), at(L::kScale + 2)};
  const Lanes qw = at(L::kRotation), qx = at(L::kRotation + 1), qy = at(L::kRotation + 2),
              qz = at(L::kRotation + 3);
  const Lanes norm2 = fma(qw, qw, fma(qx, qx, fma(qy, qy, qz * qz)));
  const Lanes inverse_norm = Lanes(1.0f) / sqrt(max(norm2, Lanes(1e-24f)));
  const Mat3<Lanes> rc = mul(light_from_world, rotationOf(qw * inverse_norm, qx * inverse_norm,
                                                          qy * inverse_norm, qz * inverse_norm));
  const Vec3<Lanes> t = mul(light_from_world, position - lanesOf(view.origin_m));
  const Lanes one(1.0f), size(static_cast<float>(view.size));
  const Lanes per_unit = Lanes(0.5f) * size / Lanes(view.half_width);
  const Lanes factor = view.parallel ? per_unit : per_unit / max(t.z, Lanes(kNearestLight_m));
  Vec3<Lanes> m0, m1;
  if (view.parallel) {
    m0 = factor * times(rc.r[0], scale);
    m1 = factor * times(rc.r[1], scale);
  } else {
    const Lanes inverse_z = one / max(t.z, Lanes(kNearestLight_m)), widest(kOffAxis * view.half_width);
    const auto ratio = [&](Lanes at_z) HWY_ATTR { return min(max(at_z * inverse_z, -widest), widest); };
    m0 = jacobianRow(rc.r[0], rc.r[2], factor, ratio(t.x), scale);
    m1 = jacobianRow(rc.r[1], rc.r[2], factor, ratio(t.y), scale);
  }
  const Vec3<Lanes> mz = times(rc.r[2], scale);
  const Covariance2<Lanes> v = covarianceOf(m0, m1, Lanes(kShadowDilation));
  const Lanes inverse = one / v.det;
  const Lanes ia = v.c * inverse, ib = -v.b * inverse, ic = v.a * inverse;
  const Lanes zx = dot(mz, m0), zy = dot(mz, m1);
  const Lanes half_log2e(-0.5f * 1.44269504f);
  store(fma(t.x, factor, Lanes(0.5f) * size), out.x);
  store(fma(t.y, factor, Lanes(0.5f) * size), out.y);
  store(half_log2e * ia, out.a);
  store(Lanes(2.0f) * half_log2e * ib, out.b);
  store(half_log2e * ic, out.c);
  store(t.z, out.z);
  store(fma(ia, zx, ib * zy), out.slope_x);
  store(fma(ib, zx, ic * zy), out.slope_y);
  store(v.a, out.var_x);
  store(v.c, out.var_y);
  unsigned cast = view.parallel ? 0xffffu : bitsOf(t.z > Lanes(kNearestLight_m));
  if (side != nullptr) {
    const Vec3<Lanes> thin = thinColumn(rc, scale);
    const Lanes along = view.parallel ? thin.z : dot(thin, t);
    cast &= bitsOf(along * load(side + i) >= Lanes(0.0f));
  }
  return cast;
}

void castSplatsLanes(const GaussianBuffers& g, const float* side, const ShadowView& view, std::size_t begin,
                     std::size_t end, ShadowSplat* splats) {
  constexpr float kCut = TracerDesc{}.cut_response, kLog2e = 1.44269504f;
  CastLanes lanes;
  for (std::size_t first = begin; first < end; first += 16) {
    const unsigned cast = castLanes(g, side, view, first, lanes);
    const std::size_t count = std::min<std::size_t>(16, end - first);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = first + k;
      ShadowSplat& s = splats[i];
      const float opacity = g.plane(PlaneLayout::kOpacity)[i];
      s.opacity = 0;
      if (((cast >> k) & 1u) == 0 || !(opacity > kCut)) continue;
      const float reach2 = 2 * std::log(opacity / kCut);
      s = {lanes.x[k],
           lanes.y[k],
           lanes.a[k],
           lanes.b[k],
           lanes.c[k],
           opacity,
           lanes.z[k],
           lanes.slope_x[k],
           lanes.slope_y[k],
           -0.5f * kLog2e * reach2,
           std::sqrt(reach2 * lanes.var_x[k]),
           std::sqrt(reach2 * lanes.var_y[k])};
      const auto size = static_cast<float>(view.size);
      const bool inside = s.x + s.half_width > 0 && s.x - s.half_width < size && s.y + s.half_height > 0 &&
                          s.y - s.half_height < size;
      if (!inside) s.opacity = 0;
    }
  }
}

HWY_INLINE void drawRow(const ShadowSplat& s, int row, int from, int to, Lanes lane, ShadowPlanes& planes) {
  const Lanes most(kMostAlpha), casting(kCastingAlpha), one(1.0f);
  const Lanes dy(static_cast<float>(row) + 0.5f - s.y);
  for (int x = from; x <= to; x += 16) {
    const Lanes dx = lane + Lanes(static_cast<float>(x) + 0.5f - s.x);
    const Lanes exponent = fma(dx, fma(Lanes(s.a), dx, Lanes(s.b) * dy), Lanes(s.c) * dy * dy);
    const Mask met = exponent >= Lanes(s.least);
    if (!any(met)) continue;
    const Lanes alpha = keepIf(met, min(Lanes(s.opacity) * exp2(max(exponent, Lanes(-100.0f))), most));
    const Lanes z = fma(Lanes(s.slope_x), dx, fma(Lanes(s.slope_y), dy, Lanes(s.z)));
    const std::size_t at = static_cast<std::size_t>(row) * planes.stride + x;
    float *nearest = planes.nearest.data() + at, *through = planes.through.data() + at,
          *weight = planes.weight.data() + at, *weighted = planes.weighted.data() + at;
    store(select(alpha > casting, min(load(nearest), z), load(nearest)), nearest);
    store(load(through) * (one - alpha), through);
    store(load(weight) + alpha, weight);
    store(fma(alpha, z, load(weighted)), weighted);
  }
}

void drawSplatRowsLanes(const ShadowSplat* splats, std::span<const std::uint32_t> drawn, int begin_row,
                        int end_row, ShadowPlanes& planes) {
  alignas(64) float numbers[16];
  for (int k = 0; k < 16; ++k) numbers[k] = static_cast<float>(k);
  const Lanes lane = load(numbers);
  const auto last = static_cast<float>(planes.size - 1);
  for (const std::uint32_t i : drawn) {
    const ShadowSplat& s = splats[i];
    const int top = std::max(begin_row, static_cast<int>(std::max(0.0f, std::floor(s.y - s.half_height))));
    const int bottom = std::min(end_row - 1, static_cast<int>(std::min(last, s.y + s.half_height)));
    const int from = static_cast<int>(std::max(0.0f, std::floor(s.x - s.half_width)));
    const int to = static_cast<int>(std::min(last, s.x + s.half_width));
    for (int row = top; row <= bottom; ++row) drawRow(s, row, from, to, lane, planes);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace beam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beam {

HWY_EXPORT(castSplatsLanes);
HWY_EXPORT(drawSplatRowsLanes);

void castSplats(const GaussianBuffers& gaussians, const float* side, const ShadowView& view,
                std::size_t begin, std::size_t end, ShadowSplat* splats) {
  HWY_DYNAMIC_DISPATCH(castSplatsLanes)(gaussians, side, view, begin, end, splats);
}
void drawSplatRows(const ShadowSplat* splats, std::span<const std::uint32_t> drawn, int begin_row,
                   int end_row, ShadowPlanes& planes) {
  HWY_DYNAMIC_DISPATCH(drawSplatRowsLanes)(splats, drawn, begin_row, end_row, planes);
}

}  // namespace beam
#endif
