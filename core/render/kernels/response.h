// SPDX-License-Identifier: Apache-2.0
// One Gaussian met by one ray: its maximum response (methods 2.1) and the hit rules of visibility rays
// (methods 4.3). Templates over F: Lanes or float; both give the same bits, so every tracer sums the same
// numbers. Include like lanes.h.
#include "core/render/kernels/project.h"

#ifdef BEAM_KERNELS_SIMD
#if defined(BEAM_RESPONSE_TOGGLE) == defined(HWY_TARGET_TOGGLE)
#ifdef BEAM_RESPONSE_TOGGLE
#undef BEAM_RESPONSE_TOGGLE
#else
#define BEAM_RESPONSE_TOGGLE
#endif
#define BEAM_KERNELS_READ
#endif
#elif !defined(BEAM_RESPONSE_ONCE)
#define BEAM_RESPONSE_ONCE
#define BEAM_KERNELS_READ
#endif

#ifdef BEAM_KERNELS_READ
#undef BEAM_KERNELS_READ
BEAM_KERNELS_BEGIN

constexpr float kAlphaUnits = 1 << 20;  // of the fixed-point sum; 16 alphas add up exactly in float

template <class F>
BEAM_INLINE Vec3<F> cross(const Vec3<F>& a, const Vec3<F>& b) {
  return {nfma(a.z, b.y, a.y * b.z), nfma(a.x, b.z, a.z * b.x), nfma(a.y, b.x, a.x * b.y)};
}

// A Gaussian as rays meet it.
template <class F>
struct RayTarget {
  Mat3<F> canonical;  // S^-1 R^T: world to standard deviations
  Vec3<F> center;
  F opacity, cut2;  // cut2: squared radius of the cut in standard deviations; negative: never met
};

template <class F>
struct RayLine {
  Vec3<F> origin, direction;
};

// Ray and Gaussian in canonical axes. `origin` is taken at the point of the ray nearest to the centre in
// world space, at ray parameter `shift`: far origins would cancel digits.
template <class F>
struct Encounter {
  Vec3<F> origin, direction;
  F shift;
  F across2;     // |origin x direction|^2
  F direction2;  // |direction|^2
};

template <class F>
BEAM_INLINE Encounter<F> encounter(const RayTarget<F>& g, const RayLine<F>& ray) {
  const Vec3<F> to_center = g.center - ray.origin, d = ray.direction;
  Encounter<F> e;
  e.shift = dot(to_center, d);
  const Vec3<F> nearest = {fma(e.shift, d.x, -to_center.x), fma(e.shift, d.y, -to_center.y),
                           fma(e.shift, d.z, -to_center.z)};
  e.origin = mul(g.canonical, nearest);
  e.direction = mul(g.canonical, d);
  const Vec3<F> across = cross(e.origin, e.direction);
  e.across2 = dot(across, across);
  e.direction2 = dot(e.direction, e.direction);
  return e;
}

// The whole line meets the cut ellipsoid. What the line misses needs no further look.
template <class F>
BEAM_INLINE auto meets(const RayTarget<F>& g, const Encounter<F>& e) {
  return e.across2 < g.cut2 * e.direction2;
}

// The maximum lies ahead of the ray's origin.
template <class F>
BEAM_INLINE auto isAhead(const Encounter<F>& e) {
  return e.shift * e.direction2 > dot(e.origin, e.direction);
}

// Ray parameter of the maximum.
template <class F>
BEAM_INLINE F maximumAt(const Encounter<F>& e) {
  return e.shift - dot(e.origin, e.direction) / e.direction2;
}

// The cut ellipsoid holds the ray's origin.
template <class F>
BEAM_INLINE auto holdsOrigin(const RayTarget<F>& g, const RayLine<F>& ray) {
  const Vec3<F> o = mul(g.canonical, ray.origin - g.center);
  return dot(o, o) < g.cut2;
}

// Opacity times the maximum response, in whole units of 1 / kAlphaUnits; only where the line meets the cut.
template <class F>
BEAM_INLINE F alphaUnits(const RayTarget<F>& g, const Encounter<F>& e) {
  const F distance2 = min(e.across2 / e.direction2, F(80.0f));  // lanes that missed may hold anything
  return roundNearest(F(kAlphaUnits) * (g.opacity * exp(F(-0.5f) * distance2)));
}

BEAM_KERNELS_END
#endif
