// SPDX-License-Identifier: Apache-2.0
// One Gaussian seen by one camera: screen ellipse, colour, depth surface and normal
// (methods 1.2-1.3, 2.1-2.3), and the gradients of all of them (methods 1.7-1.9, 2.5). Templates over F:
// Lanes, float or double. Include like lanes.h.
#include "core/render/kernels/lanes.h"

#ifdef BEAM_KERNELS_SIMD
#if defined(BEAM_PROJECT_TOGGLE) == defined(HWY_TARGET_TOGGLE)
#ifdef BEAM_PROJECT_TOGGLE
#undef BEAM_PROJECT_TOGGLE
#else
#define BEAM_PROJECT_TOGGLE
#endif
#define BEAM_KERNELS_READ
#endif
#elif !defined(BEAM_PROJECT_ONCE)
#define BEAM_PROJECT_ONCE
#define BEAM_KERNELS_READ
#endif

#ifdef BEAM_KERNELS_READ
#undef BEAM_KERNELS_READ
BEAM_KERNELS_BEGIN

template <class F>
struct Vec3 {
  F x, y, z;
};

template <class F>
BEAM_INLINE F dot(const Vec3<F>& a, const Vec3<F>& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
template <class F>
BEAM_INLINE Vec3<F> operator*(const F& s, const Vec3<F>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class F>
BEAM_INLINE Vec3<F> operator+(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
BEAM_INLINE Vec3<F> operator-(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

// Rows.
template <class F>
struct Mat3 {
  Vec3<F> r[3];
};
template <class F>
BEAM_INLINE Vec3<F> mul(const Mat3<F>& m, const Vec3<F>& v) {
  return {dot(m.r[0], v), dot(m.r[1], v), dot(m.r[2], v)};
}
template <class F>
BEAM_INLINE Vec3<F> mulTransposed(const Mat3<F>& m, const Vec3<F>& v) {
  return v.x * m.r[0] + v.y * m.r[1] + v.z * m.r[2];
}
template <class F>
BEAM_INLINE Mat3<F> mul(const Mat3<F>& a, const Mat3<F>& b) {
  return {{mulTransposed(b, a.r[0]), mulTransposed(b, a.r[1]), mulTransposed(b, a.r[2])}};
}

// The camera as numbers that all Gaussians share.
template <class F>
struct CameraConstants {
  Mat3<F> camera_from_world;
  Vec3<F> translation, center;  // center: of the camera, in world axes
  F fx, fy, cx, cy;
  F low_x, high_x, low_y,
      high_y;  // bounds of x/z and y/z inside the Jacobian: the picture grown by 0.3 (methods 1.3)
  F dilation;  // px^2
};

template <class F>
struct GaussianIn {
  Vec3<F> position;
  F qw, qx, qy, qz;  // need not be unit
  Vec3<F> scale;
};

// What both directions need of a Gaussian.
template <class F>
struct Projection {
  F qw, qx, qy, qz, inverse_norm;  // unit quaternion
  Vec3<F> t;                       // centre in camera axes
  F inverse_z, xr, yr;             // 1 / t.z; x/z and y/z as clamped
  Mat3<F> rc;                      // camera_from_gaussian
  Vec3<F> m0, m1;                  // rows of J Rc S
  F det, a, b, c;                  // 2D covariance [[a b] [b c]] and its determinant
};

template <class F>
BEAM_INLINE Mat3<F> rotationOf(F w, F x, F y, F z) {
  const F two(2.0f), one(1.0f);
  return {{{nfma(two, fma(y, y, z * z), one), two * (x * y - w * z), two * fma(x, z, w * y)},
           {two * fma(x, y, w * z), nfma(two, fma(x, x, z * z), one), two * (y * z - w * x)},
           {two * (x * z - w * y), two * fma(y, z, w * x), nfma(two, fma(x, x, y * y), one)}}};
}

template <class F>
BEAM_INLINE Vec3<F> jacobianRow(const Vec3<F>& row, const Vec3<F>& row_z, F factor, F ratio,
                                const Vec3<F>& s) {
  return {factor * nfma(ratio, row_z.x, row.x) * s.x, factor * nfma(ratio, row_z.y, row.y) * s.y,
          factor * nfma(ratio, row_z.z, row.z) * s.z};
}

// [[a b] [b c]] = M M^T + dilation I and its determinant, the rows of M being m0 and m1.
template <class F>
struct Covariance2 {
  F det, a, b, c;
};

template <class F>
BEAM_INLINE Covariance2<F> covarianceOf(const Vec3<F>& m0, const Vec3<F>& m1, F dilation) {
  const F a0 = dot(m0, m0), c0 = dot(m1, m1);
  // det(M M^T) as a sum of squares: no cancellation for needles.
  const F c01 = m0.x * m1.y - m0.y * m1.x, c02 = m0.x * m1.z - m0.z * m1.x;
  const F c12 = m0.y * m1.z - m0.z * m1.y;
  return {fma(c01, c01, fma(c02, c02, c12 * c12)) + dilation * (a0 + c0 + dilation), a0 + dilation,
          dot(m0, m1), c0 + dilation};
}

template <class F>
BEAM_INLINE Projection<F> projectGaussian(const GaussianIn<F>& g, const CameraConstants<F>& k) {
  Projection<F> p;
  const F norm2 = fma(g.qw, g.qw, fma(g.qx, g.qx, fma(g.qy, g.qy, g.qz * g.qz)));
  p.inverse_norm = F(1.0f) / sqrt(max(norm2, F(1e-24f)));
  p.qw = g.qw * p.inverse_norm, p.qx = g.qx * p.inverse_norm;
  p.qy = g.qy * p.inverse_norm, p.qz = g.qz * p.inverse_norm;
  p.t = mul(k.camera_from_world, g.position) + k.translation;
  p.inverse_z = F(1.0f) / max(p.t.z, F(1e-6f));
  p.xr = min(max(p.t.x * p.inverse_z, k.low_x), k.high_x);
  p.yr = min(max(p.t.y * p.inverse_z, k.low_y), k.high_y);
  p.rc = mul(k.camera_from_world, rotationOf(p.qw, p.qx, p.qy, p.qz));
  p.m0 = jacobianRow(p.rc.r[0], p.rc.r[2], k.fx * p.inverse_z, p.xr, g.scale);
  p.m1 = jacobianRow(p.rc.r[1], p.rc.r[2], k.fy * p.inverse_z, p.yr, g.scale);
  const Covariance2<F> v = covarianceOf(p.m0, p.m1, k.dilation);
  p.det = v.det, p.a = v.a, p.b = v.b, p.c = v.c;
  return p;
}

// Depth along the optical axis of the point of maximum response on the ray of a pixel that lies (dx, dy)
// pixels from the centre: z = tz (1 + q) / (1 + 2 q + s), q = ax dx + ay dy, s = mxx dx^2 + mxy dx dy + myy
// dy^2; and the normal of the intersection plane (methods 2.1-2.3).
template <class F>
struct DepthSurface {
  Vec3<F> normal;  // camera axes, unit, towards the camera
  F ax, ay, mxx, mxy, myy;
  F inverse_kappa;  // 1 / (r0^T Sigma_c^-1 r0), r0 the ray of the centre
};

template <class F>
BEAM_INLINE Vec3<F> inverseSquares(const Vec3<F>& s) {
  const F least(1e-6f), one(1.0f);
  const F x = max(s.x, least), y = max(s.y, least), z = max(s.z, least);
  return {one / (x * x), one / (y * y), one / (z * z)};
}

template <class F>
BEAM_INLINE DepthSurface<F> depthSurface(const Projection<F>& p, const Vec3<F>& scale,
                                         const CameraConstants<F>& k) {
  const Vec3<F> d2 = inverseSquares(scale), pt = mulTransposed(p.rc, p.t);
  const Vec3<F> dp = {d2.x * pt.x, d2.y * pt.y, d2.z * pt.z};
  const Vec3<F> w = mul(p.rc, dp);
  const F length = sqrt(dot(w, w));
  DepthSurface<F> s;
  s.normal = (F(-1.0f) / length) * w;
  const F kappa = dot(pt, dp) * p.inverse_z * p.inverse_z;
  s.inverse_kappa = F(1.0f) / kappa;
  const F ux = F(1.0f) / k.fx, uy = F(1.0f) / k.fy, scaled = s.inverse_kappa * p.inverse_z;
  s.ax = w.x * scaled * ux;
  s.ay = w.y * scaled * uy;
  const auto entry = [&](const Vec3<F>& u, const Vec3<F>& v) {
    return fma(u.x * v.x, d2.x, fma(u.y * v.y, d2.y, u.z * v.z * d2.z));
  };
  s.mxx = entry(p.rc.r[0], p.rc.r[0]) * s.inverse_kappa * ux * ux;
  s.mxy = F(2.0f) * entry(p.rc.r[0], p.rc.r[1]) * s.inverse_kappa * ux * uy;
  s.myy = entry(p.rc.r[1], p.rc.r[1]) * s.inverse_kappa * uy * uy;
  return s;
}

// Sums over the pixels of a Gaussian; d = pixel - centre. Screen part: v = dL/dalpha * response at unclamped
// hits, first and second moments of v. Depth part (methods 2.5): h = dL/dz / kappa(pixel) and z h with their
// moments.
template <class F>
struct ScreenGradient {
  Vec3<F> color;
  F o, x, y, xx, xy, yy;
  Vec3<F> normal;
  F h, hx, hy, zh, zhx, zhy, zhxx, zhxy, zhyy;
};

template <class F>
struct GaussianGradient {
  Vec3<F> position;
  F qw, qx, qy, qz;
  Vec3<F> scale;
  F opacity;
};

// Gradients by the centre in camera axes, the rotation camera_from_gaussian and the scales.
template <class F>
struct CameraGradient {
  Vec3<F> t;
  Mat3<F> rc;
  Vec3<F> scale;
};

// From the screen ellipse and the projected centre (methods 1.8, through the factor M = J Rc S: dL/dM = 2 G
// M).
template <class F>
BEAM_INLINE CameraGradient<F> ellipseBackward(const ScreenGradient<F>& s, const Projection<F>& p,
                                              const Vec3<F>& scale, F opacity, const CameraConstants<F>& k) {
  const F inverse_det = F(1.0f) / p.det;
  const F ka = p.c * inverse_det, kb = -p.b * inverse_det, kc = p.a * inverse_det;  // conic [[ka kb] [kb kc]]
  const F half(0.5f);
  // dL/d(conic): Gk = -o/2 [[xx xy] [xy yy]]; dL/d(covariance) = -K Gk K.
  const F gxx = half * opacity * s.xx, gxy = half * opacity * s.xy, gyy = half * opacity * s.yy;
  const F ux = fma(ka, gxx, kb * gxy), uy = fma(ka, gxy, kb * gyy);
  const F vx = fma(kb, gxx, kc * gxy), vy = fma(kb, gxy, kc * gyy);
  const F g00 = fma(ux, ka, uy * kb), g01 = fma(ux, kb, uy * kc), g11 = fma(vx, kb, vy * kc);
  const F two(2.0f), jx = k.fx * p.inverse_z, jy = k.fy * p.inverse_z;
  const Vec3<F> gm0 = two * (g00 * p.m0 + g01 * p.m1), gm1 = two * (g01 * p.m0 + g11 * p.m1);
  const auto times = [](const Vec3<F>& u, const Vec3<F>& v) {
    return Vec3<F>{u.x * v.x, u.y * v.y, u.z * v.z};
  };
  const Vec3<F> e0 = times(gm0, scale), e1 = times(gm1, scale);
  CameraGradient<F> g;
  g.rc.r[0] = jx * e0;
  g.rc.r[1] = jy * e1;
  g.rc.r[2] = (-jx * p.xr) * e0 - (jy * p.yr) * e1;
  const Vec3<F> n0 = p.rc.r[0] - p.xr * p.rc.r[2], n1 = p.rc.r[1] - p.yr * p.rc.r[2];
  g.scale = jx * times(gm0, n0) + jy * times(gm1, n1);
  const F zero(0.0f);
  const F d_xr = -jx * dot(e0, p.rc.r[2]), d_yr = -jy * dot(e1, p.rc.r[2]);
  const F raw_x = p.t.x * p.inverse_z, raw_y = p.t.y * p.inverse_z;
  const F gx = select((raw_x > k.low_x) & (raw_x < k.high_x), d_xr, zero);
  const F gy = select((raw_y > k.low_y) & (raw_y < k.high_y), d_yr, zero);
  // Centre: d(power)/d(mean) = K d.
  const F mx = opacity * fma(ka, s.x, kb * s.y), my = opacity * fma(kb, s.x, kc * s.y);
  g.t.x = p.inverse_z * fma(mx, k.fx, gx);
  g.t.y = p.inverse_z * fma(my, k.fy, gy);
  const F from_scale = dot(gm0, p.m0) + dot(gm1, p.m1);
  g.t.z = -p.inverse_z * (from_scale + gx * p.xr + gy * p.yr + mx * k.fx * raw_x + my * k.fy * raw_y);
  return g;
}

// From normal and depth (methods 2.5, exact depth); added to `g`.
template <class F>
BEAM_INLINE void surfaceBackward(const ScreenGradient<F>& s, const Projection<F>& p, const Vec3<F>& scale,
                                 const CameraConstants<F>& k, CameraGradient<F>& g) {
  const Vec3<F> d2 = inverseSquares(scale), pt = mulTransposed(p.rc, p.t);
  const Vec3<F> dp = {d2.x * pt.x, d2.y * pt.y, d2.z * pt.z};
  const Vec3<F> v = mul(p.rc, dp);
  const F inverse_length = F(1.0f) / sqrt(dot(v, v));
  const Vec3<F> v_hat = inverse_length * v;
  const Vec3<F> across = s.normal - dot(s.normal, v_hat) * v_hat;
  const F ux = F(1.0f) / k.fx, uy = F(1.0f) / k.fy, x0 = p.t.x * p.inverse_z, y0 = p.t.y * p.inverse_z;
  // sum h r, with r = r0 + (dx / fx, dy / fy, 0).
  const Vec3<F> hr = {fma(s.h, x0, s.hx * ux), fma(s.h, y0, s.hy * uy), s.h};
  const Vec3<F> g_v = hr - inverse_length * across;
  // sum z h r r^T, symmetric.
  const F kx = s.zhx * ux, ky = s.zhy * uy, two(2.0f);
  const F rxx = fma(s.zh * x0, x0, fma(two * x0, kx, s.zhxx * ux * ux));
  const F rxy = fma(s.zh * x0, y0, fma(x0, ky, fma(y0, kx, s.zhxy * ux * uy)));
  const F ryy = fma(s.zh * y0, y0, fma(two * y0, ky, s.zhyy * uy * uy));
  const F rxz = fma(s.zh, x0, kx), ryz = fma(s.zh, y0, ky);
  const Mat3<F> rr = {{{rxx, rxy, rxz}, {rxy, ryy, ryz}, {rxz, ryz, s.zh}}};
  const Mat3<F> rr_rc = mul(rr, p.rc);
  const Vec3<F> a = mulTransposed(p.rc, g_v);
  const Vec3<F> da = {d2.x * a.x, d2.y * a.y, d2.z * a.z};
  g.t = g.t + mul(p.rc, da);
  const F gv[3] = {g_v.x, g_v.y, g_v.z}, t[3] = {p.t.x, p.t.y, p.t.z};
  for (int i = 0; i < 3; ++i) {
    const Vec3<F> spread = {rr_rc.r[i].x * d2.x, rr_rc.r[i].y * d2.y, rr_rc.r[i].z * d2.z};
    g.rc.r[i] = g.rc.r[i] + (gv[i] * dp + t[i] * da - two * spread);
  }
  const auto column = [&](F c0, F c1, F c2, F e0, F e1, F e2) { return fma(c0, e0, fma(c1, e1, c2 * e2)); };
  const Mat3<F>& r = p.rc;
  const F q0 = column(r.r[0].x, r.r[1].x, r.r[2].x, rr_rc.r[0].x, rr_rc.r[1].x, rr_rc.r[2].x);
  const F q1 = column(r.r[0].y, r.r[1].y, r.r[2].y, rr_rc.r[0].y, rr_rc.r[1].y, rr_rc.r[2].y);
  const F q2 = column(r.r[0].z, r.r[1].z, r.r[2].z, rr_rc.r[0].z, rr_rc.r[1].z, rr_rc.r[2].z);
  const F least(1e-6f);
  g.scale.x = g.scale.x - two * d2.x / max(scale.x, least) * (pt.x * a.x - q0);
  g.scale.y = g.scale.y - two * d2.y / max(scale.y, least) * (pt.y * a.y - q1);
  g.scale.z = g.scale.z - two * d2.z / max(scale.z, least) * (pt.z * a.z - q2);
}

// To position (without the SH path), raw quaternion, scale and opacity.
template <class F>
BEAM_INLINE GaussianGradient<F> toGaussian(const CameraGradient<F>& g, const Projection<F>& p,
                                           F opacity_gradient, const CameraConstants<F>& k) {
  GaussianGradient<F> out;
  out.position = mulTransposed(k.camera_from_world, g.t);
  out.scale = g.scale;
  out.opacity = opacity_gradient;
  Mat3<F> w;  // camera_from_world^T
  w.r[0] = {k.camera_from_world.r[0].x, k.camera_from_world.r[1].x, k.camera_from_world.r[2].x};
  w.r[1] = {k.camera_from_world.r[0].y, k.camera_from_world.r[1].y, k.camera_from_world.r[2].y};
  w.r[2] = {k.camera_from_world.r[0].z, k.camera_from_world.r[1].z, k.camera_from_world.r[2].z};
  const Mat3<F> m = mul(w, g.rc);  // dL/dR
  const F two(2.0f);
  const F m01 = m.r[0].y, m02 = m.r[0].z, m10 = m.r[1].x, m12 = m.r[1].z, m20 = m.r[2].x, m21 = m.r[2].y;
  const F m00 = m.r[0].x, m11 = m.r[1].y, m22 = m.r[2].z;
  const F dw = two * fma(p.qx, m21 - m12, fma(p.qy, m02 - m20, p.qz * (m10 - m01)));
  const F dx =
      two * (fma(p.qy, m01 + m10, fma(p.qz, m02 + m20, p.qw * (m21 - m12))) - two * p.qx * (m11 + m22));
  const F dy =
      two * (fma(p.qx, m01 + m10, fma(p.qz, m12 + m21, p.qw * (m02 - m20))) - two * p.qy * (m00 + m22));
  const F dz =
      two * (fma(p.qx, m02 + m20, fma(p.qy, m12 + m21, p.qw * (m10 - m01))) - two * p.qz * (m00 + m11));
  const F along = fma(p.qw, dw, fma(p.qx, dx, fma(p.qy, dy, p.qz * dz)));
  out.qw = (dw - p.qw * along) * p.inverse_norm;
  out.qx = (dx - p.qx * along) * p.inverse_norm;
  out.qy = (dy - p.qy * along) * p.inverse_norm;
  out.qz = (dz - p.qz * along) * p.inverse_norm;
  return out;
}

BEAM_KERNELS_END
#endif
