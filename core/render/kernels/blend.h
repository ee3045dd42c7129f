// SPDX-License-Identifier: Apache-2.0
// One Gaussian over one 4x4 block of pixels: response, depth, and which blocks of a tile its ellipse touches
// (methods 1.4-1.5, 2.1). Include like lanes.h.
#include "core/render/cpu/raster_state.h"
#include "core/render/kernels/lanes.h"

#ifdef BEAM_KERNELS_SIMD
#if defined(BEAM_BLEND_TOGGLE) == defined(HWY_TARGET_TOGGLE)
#ifdef BEAM_BLEND_TOGGLE
#undef BEAM_BLEND_TOGGLE
#else
#define BEAM_BLEND_TOGGLE
#endif
#define BEAM_KERNELS_READ
#endif
#elif !defined(BEAM_BLEND_ONCE)
#define BEAM_BLEND_ONCE
#define BEAM_KERNELS_READ
#endif

#ifdef BEAM_KERNELS_READ
#undef BEAM_KERNELS_READ
BEAM_KERNELS_BEGIN

alignas(64) constexpr float kLaneX[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) constexpr float kLaneY[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
alignas(64) constexpr float kBlockX[16] = {0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12};
alignas(64) constexpr float kBlockY[16] = {0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12};

// Largest x of the ellipse in a row: a x^2 + b x y + c y^2 = -limit.
BEAM_INLINE Lanes rightEnd(const ScreenSplat& s, Lanes y) {
  const Lanes by = Lanes(s.b) * y;
  const Lanes inner = fma(Lanes(s.c) * y, y, Lanes(s.limit));
  const Lanes discriminant = max(fma(by, by, Lanes(-4 * s.a) * inner), Lanes(0.0f));
  return (by + sqrt(discriminant)) * Lanes(s.inverse_2a);
}

// Bit 4 row + column for each of the tile's 16 blocks that the ellipse touches; (x, y): centre relative to
// the tile's first pixel centre.
BEAM_INLINE unsigned touchedBlocks(const ScreenSplat& s, float x, float y) {
  const Lanes h(s.half_height), top = load(kBlockY) - Lanes(y), bottom = top + Lanes(3.0f);
  const Lanes ya = max(top, -h), yb = min(bottom, h), extreme(s.rightmost_y);
  const Lanes right = Lanes(x) + rightEnd(s, min(max(extreme, ya), yb));
  const Lanes left = Lanes(x) - rightEnd(s, min(max(extreme, -yb), -ya));
  const Lanes first = load(kBlockX), last = first + Lanes(3.0f);
  return bitsOf((top <= h) & (bottom >= -h) & (right >= first) & (left <= last));
}

struct BlockResponse {
  Lanes dx, dy;    // pixel - centre
  Lanes response;  // G in (0, 1]
  Lanes alpha;     // min(0.99, o G), 0 where it is no hit
  Mask hit;        // o G >= 1/255 and the pixel is not opaque
};

// (x, y): centre relative to the block's first pixel centre; `transmittance` < 0 marks opaque pixels.
BEAM_INLINE BlockResponse respond(const ScreenSplat& s, float x, float y, Lanes transmittance) {
  BlockResponse r;
  r.dx = load(kLaneX) - Lanes(x);
  r.dy = load(kLaneY) - Lanes(y);
  const Lanes power = fma(r.dx, fma(Lanes(s.a), r.dx, Lanes(s.b) * r.dy), (Lanes(s.c) * r.dy) * r.dy);
  r.response = exp2(min(max(power, Lanes(-126.0f)), Lanes(0.0f)));
  const Lanes full = Lanes(s.opacity) * r.response;
  r.hit = (full >= Lanes(kMinAlpha)) & (transmittance > Lanes(0.0f));
  r.alpha = keepIf(r.hit, min(full, Lanes(kMaxAlpha)));
  return r;
}

// Takes the pixels that this Gaussian would make opaque out of the hit (methods 1.5: they stop before it).
// Returns the weights alpha T and moves the transmittance on.
BEAM_INLINE Lanes weigh(BlockResponse& r, Lanes& transmittance) {
  const Lanes w = r.alpha * transmittance, after = transmittance - w;
  const Mask stop = r.hit & (after < Lanes(kMinTransmittance));
  r.hit = r.hit & !stop;
  r.alpha = keepIf(r.hit, r.alpha);
  const Lanes weight = keepIf(r.hit, w);
  transmittance = select(stop, -transmittance, select(r.hit, after, transmittance));
  return weight;
}

// Depth along the optical axis; `inside`: where it was not held to [0.5, 2] of the centre's.
struct BlockDepth {
  Lanes z;
  Lanes inverse_d;  // 1 / (1 + 2 q + s)
  Mask inside;
};
BEAM_INLINE BlockDepth depthAt(const ScreenSplat& s, const SurfaceSplat& f, const BlockResponse& r) {
  const Lanes one(1.0f);
  const Lanes q = fma(Lanes(f.ax), r.dx, Lanes(f.ay) * r.dy);
  const Lanes curve = fma(r.dx, fma(Lanes(f.mxx), r.dx, Lanes(f.mxy) * r.dy), (Lanes(f.myy) * r.dy) * r.dy);
  BlockDepth d;
  d.inverse_d = one / max(fma(Lanes(2.0f), q, one + curve), Lanes(1e-4f));
  const Lanes ratio = (one + q) * d.inverse_d;
  d.inside = (ratio > Lanes(0.5f)) & (ratio < Lanes(2.0f));
  d.z = Lanes(s.z) * min(max(ratio, Lanes(0.5f)), Lanes(2.0f));
  return d;
}

BEAM_KERNELS_END
#endif
