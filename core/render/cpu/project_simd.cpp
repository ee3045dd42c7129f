// SPDX-License-Identifier: Apache-2.0
// Gaussians to the screen and gradients back, 16 Gaussians at a time.
#define BEAM_KERNELS_SIMD
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/render/cpu/project_simd.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include <algorithm>
#include <cmath>

#include "core/render/cpu/raster_state.h"
#include "core/render/kernels/sh_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace beam {
namespace HWY_NAMESPACE {

using L = PlaneLayout;

CameraConstants<Lanes> cameraLanes(const RasterCameraConstants& c) {
  const auto f = [](double v) { return Lanes(static_cast<float>(v)); };
  CameraConstants<Lanes> k;
  for (int i = 0; i < 3; ++i)
    k.camera_from_world.r[i] = {f(c.rotation[3 * i]), f(c.rotation[3 * i + 1]), f(c.rotation[3 * i + 2])};
  k.translation = {f(c.translation[0]), f(c.translation[1]), f(c.translation[2])};
  k.center = {f(c.center[0]), f(c.center[1]), f(c.center[2])};
  const Intrinsics& n = c.intrinsics;
  k.fx = f(n.fx), k.fy = f(n.fy), k.cx = f(n.cx), k.cy = f(n.cy);
  const double tan_x = 0.5 * c.width / n.fx, tan_y = 0.5 * c.height / n.fy;
  k.low_x = f(-n.cx / n.fx - 0.3 * tan_x), k.high_x = f((c.width - n.cx) / n.fx + 0.3 * tan_x);
  k.low_y = f(-n.cy / n.fy - 0.3 * tan_y), k.high_y = f((c.height - n.cy) / n.fy + 0.3 * tan_y);
  k.dilation = Lanes(c.dilation_px2);
  return k;
}

HWY_INLINE GaussianIn<Lanes> loadGaussians(const GaussianBuffers& g, std::size_t i) {
  const auto at = [&](int plane) HWY_ATTR { return load(g.plane(plane) + i); };
  return {{at(L::kPosition), at(L::kPosition + 1), at(L::kPosition + 2)},
          at(L::kRotation),
          at(L::kRotation + 1),
          at(L::kRotation + 2),
          at(L::kRotation + 3),
          {at(L::kScale), at(L::kScale + 1), at(L::kScale + 2)}};
}

HWY_INLINE Vec3<Lanes> viewDirection(const Vec3<Lanes>& position, const CameraConstants<Lanes>& k,
                                     Lanes& inverse_distance) {
  const Vec3<Lanes> d = position - k.center;
  inverse_distance = Lanes(1.0f) / sqrt(max(dot(d, d), Lanes(1e-12f)));
  return inverse_distance * d;
}

// max(0, 0.5 + SH) a channel.
HWY_INLINE void colorOf(const GaussianBuffers& g, std::size_t i, const Vec3<Lanes>& direction, int degree,
                        Lanes* rgb) {
  Lanes basis[16];
  shBasisOf(direction, degree, basis);
  const int count = (degree + 1) * (degree + 1);
  for (int c = 0; c < 3; ++c) rgb[c] = Lanes(0.5f);
  for (int k = 0; k < count; ++k) {
    for (int c = 0; c < 3; ++c) rgb[c] = fma(basis[k], load(g.plane(L::kSh + 3 * k + c) + i), rgb[c]);
  }
  for (int c = 0; c < 3; ++c) rgb[c] = max(rgb[c], Lanes(0.0f));
}

// Ellipse data that the blend reads, scaled to base 2. `extent2`: squared radius in standard deviations.
HWY_INLINE void storeScreen(const Projection<Lanes>& p, const CameraConstants<Lanes>& k, Lanes opacity,
                            Lanes extent2, const Lanes* rgb, float (*out)[16]) {
  const Lanes inverse_det = Lanes(1.0f) / p.det, log2e(1.44269504f), half(0.5f);
  const Lanes a = -half * log2e * p.c * inverse_det, height = sqrt(p.c * extent2),
              width = sqrt(p.a * extent2);
  store(fma(k.fx, p.t.x * p.inverse_z, k.cx), out[0]);
  store(fma(k.fy, p.t.y * p.inverse_z, k.cy), out[1]);
  store(a, out[2]);
  store(log2e * p.b * inverse_det, out[3]);
  store(-half * log2e * p.a * inverse_det, out[4]);
  store(opacity, out[5]);
  for (int c = 0; c < 3; ++c) store(rgb[c], out[6 + c]);
  store(p.t.z, out[9]);
  store(p.b / p.a * width, out[10]);
  store(height, out[11]);
  store(half * log2e * extent2, out[12]);
  store(Lanes(-0.5f) / a, out[13]);
  store(max(width, height), out[14]);
}

// Squared extent in standard deviations, 2 ln(255 o), grown a little against rounding; negative: never
// reaches 1/255.
HWY_INLINE Lanes squaredExtent(Lanes opacity) {
  float o[16], e[16];
  store(opacity, o);
  for (int i = 0; i < 16; ++i) e[i] = o[i] > kMinAlpha ? 2 * std::log(o[i] / kMinAlpha) + 1e-4f : -1.0f;
  return load(e);
}

void projectRange(const GaussianBuffers& g, RasterState& state, std::size_t begin, std::size_t end) {
  const CameraConstants<Lanes> k = cameraLanes(state.camera);
  const float width = static_cast<float>(state.camera.width),
              height = static_cast<float>(state.camera.height);
  for (std::size_t i = begin; i < end; i += 16) {
    const int used = static_cast<int>(std::min<std::size_t>(16, end - i));
    const GaussianIn<Lanes> in = loadGaussians(g, i);
    const Projection<Lanes> p = projectGaussian(in, k);
    const Lanes opacity = load(g.plane(L::kOpacity) + i), extent2 = squaredExtent(opacity);
    const Mask visible = (p.t.z > Lanes(kNear_m)) & (extent2 > Lanes(0.0f)) & (p.det > Lanes(1e-12f));
    ScreenSplat* splats = &state.splats[i];
    const unsigned drawn = bitsOf(visible);
    if (drawn == 0) {
      for (int j = 0; j < used; ++j) splats[j].z = 0, state.radius[i + j] = 0;
      continue;
    }
    Lanes inverse_distance, rgb[3] = {Lanes(0.0f), Lanes(0.0f), Lanes(0.0f)};
    const Vec3<Lanes> direction = viewDirection(in.position, k, inverse_distance);
    if (state.color) colorOf(g, i, direction, state.sh_degree, rgb);
    alignas(64) float s[16][16] = {};
    storeScreen(p, k, opacity, max(extent2, Lanes(0.0f)), rgb, s);
    alignas(64) float d[16][16];
    if (state.geometry) {
      const DepthSurface<Lanes> f = depthSurface(p, in.scale, k);
      const Lanes values[9] = {f.normal.x, f.normal.y, f.normal.z, f.ax,           f.ay,
                               f.mxx,      f.mxy,      f.myy,      f.inverse_kappa};
      for (int c = 0; c < 9; ++c) store(values[c], d[c]);
    }
    for (int j = 0; j < used; ++j) {
      float* out = &splats[j].x;
      for (int c = 0; c < 15; ++c) out[c] = s[c][j];
      const ScreenSplat& q = splats[j];
      const bool on_screen =
          q.x + q.radius > 0 && q.y + q.radius > 0 && q.x - q.radius < width && q.y - q.radius < height;
      if (!((drawn >> j) & 1) || !on_screen) splats[j].z = 0;
      state.radius[i + j] = splats[j].z > 0 ? q.radius : 0;
      if (!state.geometry) continue;
      float* surface = &state.surfaces[i + j].nx;
      for (int c = 0; c < 9; ++c) surface[c] = d[c][j];
    }
  }
}

// Sums the slots of one Gaussian in order; slot_floats is a multiple of 4.
HWY_INLINE void gatherSlots(const RasterState& state, std::size_t i, float* sum) {
  const int floats = state.slot_floats;
  std::fill_n(sum, floats, 0.0f);
  for (std::uint32_t slot = state.first_slot[i]; slot < state.first_slot[i + 1]; ++slot) {
    const float* from = &state.slot_gradients[static_cast<std::size_t>(slot) * floats];
    for (int c = 0; c < floats; ++c) sum[c] += from[c];
  }
}

// SH coefficients and, through the view direction, the position.
HWY_INLINE void colorBackward(const GaussianBuffers& g, std::size_t i, const CameraConstants<Lanes>& k,
                              int degree, const Lanes* d_rgb, GaussianBuffers& out, Vec3<Lanes>& d_position) {
  const Vec3<Lanes> position = {load(g.plane(0) + i), load(g.plane(1) + i), load(g.plane(2) + i)};
  Lanes inverse_distance, basis[16];
  const Vec3<Lanes> direction = viewDirection(position, k, inverse_distance);
  shBasisOf(direction, degree, basis);
  const int count = (degree + 1) * (degree + 1);
  Lanes rgb[3], open[3], u[16];
  colorOf(g, i, direction, degree, rgb);
  for (int c = 0; c < 3; ++c) open[c] = keepIf(rgb[c] > Lanes(0.0f), d_rgb[c]);
  for (int n = 0; n < 16; ++n) {
    u[n] = Lanes(0.0f);
    for (int c = 0; c < 3; ++c) {
      const int plane = L::kSh + 3 * n + c;
      store(n < count ? basis[n] * open[c] : Lanes(0.0f), out.plane(plane) + i);
      if (n < count) u[n] = fma(open[c], load(g.plane(plane) + i), u[n]);
    }
  }
  const Vec3<Lanes> dd = shDirectionGradient(direction, degree, u);
  const Vec3<Lanes> across = dd - dot(direction, dd) * direction;
  d_position = d_position + inverse_distance * across;
}

void chainRange(const GaussianBuffers& g, const RasterState& state, std::size_t begin, std::size_t end,
                GaussianBuffers& out) {
  const CameraConstants<Lanes> k = cameraLanes(state.camera);
  for (std::size_t i = begin; i < end; i += 16) {
    const int used = static_cast<int>(std::min<std::size_t>(16, end - i));
    alignas(64) float sums[16][48] = {};
    alignas(64) float drawn[16] = {};
    bool anything = false;
    for (int j = 0; j < used; ++j) {
      if (state.splats[i + j].z <= 0 || state.first_slot[i + j] == state.first_slot[i + j + 1]) continue;
      gatherSlots(state, i + j, sums[j]);
      drawn[j] = 1;
      anything = true;
    }
    if (!anything) {
      for (int p = 0; p < out.planes(); ++p) std::fill_n(out.plane(p) + i, 16, 0.0f);
      continue;
    }
    const auto column = [&](int c) HWY_ATTR {
      alignas(64) float v[16];
      for (int j = 0; j < 16; ++j) v[j] = sums[j][c];
      return load(v);
    };
    const Mask valid = load(drawn) > Lanes(0.0f);
    const GaussianIn<Lanes> in = loadGaussians(g, i);
    const Projection<Lanes> p = projectGaussian(in, k);
    const Lanes opacity = load(g.plane(L::kOpacity) + i);
    ScreenGradient<Lanes> s;
    const Lanes d_rgb[3] = {column(0), column(1), column(2)};
    s.o = column(3), s.x = column(4), s.y = column(5), s.xx = column(6), s.xy = column(7), s.yy = column(8);
    CameraGradient<Lanes> c = ellipseBackward(s, p, in.scale, opacity, k);
    int next = 9;
    if (state.geometry) {
      s.normal = {column(9), column(10), column(11)};
      s.h = column(12), s.hx = column(13), s.hy = column(14), s.zh = column(15), s.zhx = column(16);
      s.zhy = column(17), s.zhxx = column(18), s.zhxy = column(19), s.zhyy = column(20);
      surfaceBackward(s, p, in.scale, k, c);
      next = 21;
    }
    GaussianGradient<Lanes> o = toGaussian(c, p, s.o, k);
    if (state.color) {
      colorBackward(g, i, k, state.sh_degree, d_rgb, out, o.position);
    } else {
      for (int plane = L::kSh; plane < L::kExtra; ++plane) std::fill_n(out.plane(plane) + i, 16, 0.0f);
    }
    const Lanes values[11] = {o.position.x, o.position.y, o.position.z, o.qw,      o.qx,     o.qy,
                              o.qz,         o.scale.x,    o.scale.y,    o.scale.z, o.opacity};
    for (int plane = 0; plane < 11; ++plane) store(keepIf(valid, values[plane]), out.plane(plane) + i);
    for (int e = 0; e < state.extra_channels; ++e) store(column(next + e), out.plane(L::kExtra + e) + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace beam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beam {

HWY_EXPORT(projectRange);
HWY_EXPORT(chainRange);

void projectSplats(const GaussianBuffers& gaussians, RasterState& state, std::size_t begin, std::size_t end) {
  HWY_DYNAMIC_DISPATCH(projectRange)(gaussians, state, begin, end);
}

void chainGradients(const GaussianBuffers& gaussians, const RasterState& state, std::size_t begin,
                    std::size_t end, GaussianBuffers& gradients) {
  HWY_DYNAMIC_DISPATCH(chainRange)(gaussians, state, begin, end, gradients);
}

}  // namespace beam
#endif
