// SPDX-License-Identifier: Apache-2.0
// Lanes: a pack of 16 floats with operators, one formula for AVX-512 (one vector), AVX2 (two) and plain
// arrays; all three give the same bits: explicit fma, exact division and square root, sums of a fixed shape,
// so that a result is the same on every machine. Include between the passes of hwy/foreach_target.h (toggling
// guard) in files that define BEAM_KERNELS_SIMD; elsewhere the array form in beam::scalar is what one gets.
// Never pass Lanes across files.
#include "core/render/kernels/kernel_space.h"

#ifdef BEAM_KERNELS_SIMD
#if defined(BEAM_LANES_TOGGLE) == defined(HWY_TARGET_TOGGLE)
#ifdef BEAM_LANES_TOGGLE
#undef BEAM_LANES_TOGGLE
#else
#define BEAM_LANES_TOGGLE
#endif
#define BEAM_KERNELS_READ
#endif
#elif !defined(BEAM_LANES_ONCE)
#define BEAM_LANES_ONCE
#define BEAM_KERNELS_READ
#endif

#ifdef BEAM_KERNELS_READ
#undef BEAM_KERNELS_READ
BEAM_KERNELS_BEGIN

#if BEAM_KERNELS_VECTOR

namespace hn = hwy::HWY_NAMESPACE;
using LaneTag = hn::CappedTag<float, 16>;
using LaneIntTag = hn::RebindToSigned<LaneTag>;
using LaneVector = hn::Vec<LaneTag>;
using LaneMask = hn::Mask<LaneTag>;
constexpr int kVectors = HWY_TARGET == HWY_AVX3 ? 1 : 2;
constexpr int kVectorLanes = 16 / kVectors;

struct Mask {
  LaneMask m[kVectors];
};

struct Lanes {
  LaneVector v[kVectors];
  Lanes() = default;
  HWY_INLINE Lanes(float x) {  // NOLINT: formulas mix packs and constants
    for (int i = 0; i < kVectors; ++i) v[i] = hn::Set(LaneTag(), x);
  }
};

#define BEAM_LANEWISE(expression)                         \
  Lanes r;                                                \
  for (int i = 0; i < kVectors; ++i) r.v[i] = expression; \
  return r
#define BEAM_MASKWISE(expression)                         \
  Mask r;                                                 \
  for (int i = 0; i < kVectors; ++i) r.m[i] = expression; \
  return r

HWY_INLINE Lanes load(const float* p) { BEAM_LANEWISE(hn::LoadU(LaneTag(), p + i * kVectorLanes)); }
HWY_INLINE void store(Lanes a, float* p) {
  for (int i = 0; i < kVectors; ++i) hn::StoreU(a.v[i], LaneTag(), p + i * kVectorLanes);
}
HWY_INLINE Lanes operator+(Lanes a, Lanes b) { BEAM_LANEWISE(hn::Add(a.v[i], b.v[i])); }
HWY_INLINE Lanes operator-(Lanes a, Lanes b) { BEAM_LANEWISE(hn::Sub(a.v[i], b.v[i])); }
HWY_INLINE Lanes operator-(Lanes a) { BEAM_LANEWISE(hn::Neg(a.v[i])); }
HWY_INLINE Lanes operator*(Lanes a, Lanes b) { BEAM_LANEWISE(hn::Mul(a.v[i], b.v[i])); }
HWY_INLINE Lanes operator/(Lanes a, Lanes b) { BEAM_LANEWISE(hn::Div(a.v[i], b.v[i])); }
// a b + c and c - a b, rounded once.
HWY_INLINE Lanes fma(Lanes a, Lanes b, Lanes c) { BEAM_LANEWISE(hn::MulAdd(a.v[i], b.v[i], c.v[i])); }
HWY_INLINE Lanes nfma(Lanes a, Lanes b, Lanes c) { BEAM_LANEWISE(hn::NegMulAdd(a.v[i], b.v[i], c.v[i])); }
HWY_INLINE Lanes sqrt(Lanes a) { BEAM_LANEWISE(hn::Sqrt(a.v[i])); }
HWY_INLINE Lanes abs(Lanes a) { BEAM_LANEWISE(hn::Abs(a.v[i])); }
HWY_INLINE Mask operator<(Lanes a, Lanes b) { BEAM_MASKWISE(hn::Lt(a.v[i], b.v[i])); }
HWY_INLINE Mask operator<=(Lanes a, Lanes b) { BEAM_MASKWISE(hn::Le(a.v[i], b.v[i])); }
HWY_INLINE Mask operator>(Lanes a, Lanes b) { BEAM_MASKWISE(hn::Gt(a.v[i], b.v[i])); }
HWY_INLINE Mask operator>=(Lanes a, Lanes b) { BEAM_MASKWISE(hn::Ge(a.v[i], b.v[i])); }
HWY_INLINE Mask operator&(Mask a, Mask b) { BEAM_MASKWISE(hn::And(a.m[i], b.m[i])); }
HWY_INLINE Mask operator|(Mask a, Mask b) { BEAM_MASKWISE(hn::Or(a.m[i], b.m[i])); }
HWY_INLINE Mask operator!(Mask a) { BEAM_MASKWISE(hn::Not(a.m[i])); }
HWY_INLINE Lanes select(Mask m, Lanes yes, Lanes no) {
  BEAM_LANEWISE(hn::IfThenElse(m.m[i], yes.v[i], no.v[i]));
}
HWY_INLINE Lanes keepIf(Mask m, Lanes a) { BEAM_LANEWISE(hn::IfThenElseZero(m.m[i], a.v[i])); }
// As select(a < b, a, b), which is what x86's instruction computes for every input.
HWY_INLINE Lanes min(Lanes a, Lanes b) { BEAM_LANEWISE(hn::Min(a.v[i], b.v[i])); }
HWY_INLINE Lanes max(Lanes a, Lanes b) { BEAM_LANEWISE(hn::Max(a.v[i], b.v[i])); }
HWY_INLINE unsigned bitsOf(Mask m) {
  unsigned bits = 0;
  for (int i = 0; i < kVectors; ++i) {
    std::uint8_t b[8] = {};
    hn::StoreMaskBits(LaneTag(), m.m[i], b);
    bits |= (unsigned(b[0]) | unsigned(b[1]) << 8) << (i * kVectorLanes);
  }
  return bits;
}
HWY_INLINE bool any(Mask m) {
  bool found = false;
  for (int i = 0; i < kVectors; ++i) found |= !hn::AllFalse(LaneTag(), m.m[i]);
  return found;
}
HWY_INLINE Lanes roundNearest(Lanes a) { BEAM_LANEWISE(hn::Round(a.v[i])); }
// 2^n for whole n in [-126, 127].
HWY_INLINE Lanes powerOfTwo(Lanes n) {
  BEAM_LANEWISE(hn::BitCast(LaneTag(), hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(LaneIntTag(), n.v[i]),
                                                                 hn::Set(LaneIntTag(), 127)))));
}

#undef BEAM_LANEWISE
#undef BEAM_MASKWISE

using HalfTag = hn::CappedTag<float, 8>;
using HalfVector = hn::Vec<HalfTag>;

HWY_INLINE HalfVector foldedHalf(Lanes a) {
#if HWY_TARGET == HWY_AVX3
  return hn::Add(hn::LowerHalf(HalfTag(), a.v[0]), hn::UpperHalf(HalfTag(), a.v[0]));
#else
  return hn::Add(a.v[0], a.v[1]);
#endif
}

// The sums of four packs. Shape: t_i = x_i + x_(i+8); ((t0 + t2) + (t1 + t3)) + ((t4 + t6) + (t5 + t7)).
HWY_INLINE void sum4(Lanes a, Lanes b, Lanes c, Lanes d, float* out) {
  const HalfTag h;
  const hn::RepartitionToWide<HalfTag> wide;
  const auto pairs = [&](HalfVector p, HalfVector q) HWY_ATTR {
    return hn::Add(hn::InterleaveLower(h, p, q), hn::InterleaveUpper(h, p, q));
  };
  const HalfVector ab = pairs(foldedHalf(a), foldedHalf(b)), cd = pairs(foldedHalf(c), foldedHalf(d));
  const auto low = hn::InterleaveLower(wide, hn::BitCast(wide, ab), hn::BitCast(wide, cd));
  const auto high = hn::InterleaveUpper(wide, hn::BitCast(wide, ab), hn::BitCast(wide, cd));
  const HalfVector s = hn::Add(hn::BitCast(h, low), hn::BitCast(h, high));
  const hn::CappedTag<float, 4> quarter;
  hn::StoreU(hn::Add(hn::LowerHalf(quarter, s), hn::UpperHalf(quarter, s)), quarter, out);
}

#else  // plain arrays

struct Mask {
  bool m[16];
};

struct Lanes {
  float v[16];
  Lanes() = default;
  Lanes(float x) {  // NOLINT: formulas mix packs and constants
    for (float& l : v) l = x;
  }
};

#define BEAM_LANEWISE(expression)                   \
  Lanes r;                                          \
  for (int i = 0; i < 16; ++i) r.v[i] = expression; \
  return r
#define BEAM_MASKWISE(expression)                   \
  Mask r;                                           \
  for (int i = 0; i < 16; ++i) r.m[i] = expression; \
  return r

inline Lanes load(const float* p) { BEAM_LANEWISE(p[i]); }
inline void store(Lanes a, float* p) {
  for (int i = 0; i < 16; ++i) p[i] = a.v[i];
}
inline Lanes operator+(Lanes a, Lanes b) { BEAM_LANEWISE(a.v[i] + b.v[i]); }
inline Lanes operator-(Lanes a, Lanes b) { BEAM_LANEWISE(a.v[i] - b.v[i]); }
inline Lanes operator-(Lanes a) { BEAM_LANEWISE(-a.v[i]); }
inline Lanes operator*(Lanes a, Lanes b) { BEAM_LANEWISE(a.v[i] * b.v[i]); }
inline Lanes operator/(Lanes a, Lanes b) { BEAM_LANEWISE(a.v[i] / b.v[i]); }
inline Lanes fma(Lanes a, Lanes b, Lanes c) { BEAM_LANEWISE(std::fma(a.v[i], b.v[i], c.v[i])); }
inline Lanes nfma(Lanes a, Lanes b, Lanes c) { BEAM_LANEWISE(std::fma(-a.v[i], b.v[i], c.v[i])); }
inline Lanes sqrt(Lanes a) { BEAM_LANEWISE(std::sqrt(a.v[i])); }
inline Lanes abs(Lanes a) { BEAM_LANEWISE(std::abs(a.v[i])); }
inline Mask operator<(Lanes a, Lanes b) { BEAM_MASKWISE(a.v[i] < b.v[i]); }
inline Mask operator<=(Lanes a, Lanes b) { BEAM_MASKWISE(a.v[i] <= b.v[i]); }
inline Mask operator>(Lanes a, Lanes b) { BEAM_MASKWISE(a.v[i] > b.v[i]); }
inline Mask operator>=(Lanes a, Lanes b) { BEAM_MASKWISE(a.v[i] >= b.v[i]); }
inline Mask operator&(Mask a, Mask b) { BEAM_MASKWISE(a.m[i] && b.m[i]); }
inline Mask operator|(Mask a, Mask b) { BEAM_MASKWISE(a.m[i] || b.m[i]); }
inline Mask operator!(Mask a) { BEAM_MASKWISE(!a.m[i]); }
inline Lanes select(Mask m, Lanes yes, Lanes no) { BEAM_LANEWISE(m.m[i] ? yes.v[i] : no.v[i]); }
inline Lanes keepIf(Mask m, Lanes a) { BEAM_LANEWISE(m.m[i] ? a.v[i] : 0.0f); }
inline Lanes min(Lanes a, Lanes b) { return select(a < b, a, b); }
inline Lanes max(Lanes a, Lanes b) { return select(a > b, a, b); }
inline unsigned bitsOf(Mask m) {
  unsigned bits = 0;
  for (int i = 0; i < 16; ++i) bits |= unsigned(m.m[i]) << i;
  return bits;
}
inline bool any(Mask m) { return bitsOf(m) != 0; }
inline Lanes roundNearest(Lanes a) { BEAM_LANEWISE(std::nearbyint(a.v[i])); }
inline Lanes powerOfTwo(Lanes n) {
  BEAM_LANEWISE(std::bit_cast<float>((static_cast<std::int32_t>(n.v[i]) + 127) << 23));
}

#undef BEAM_LANEWISE
#undef BEAM_MASKWISE

inline float sumOf(const Lanes& a) {
  float t[8];
  for (int i = 0; i < 8; ++i) t[i] = a.v[i] + a.v[i + 8];
  return ((t[0] + t[2]) + (t[1] + t[3])) + ((t[4] + t[6]) + (t[5] + t[7]));
}
inline void sum4(Lanes a, Lanes b, Lanes c, Lanes d, float* out) {
  out[0] = sumOf(a), out[1] = sumOf(b), out[2] = sumOf(c), out[3] = sumOf(d);
}

#endif

#if !BEAM_KERNELS_VECTOR
// One float or double as the F of a formula: for oracles and tests.
template <class T>
inline T fma(T a, T b, T c) {
  return std::fma(a, b, c);
}
template <class T>
inline T nfma(T a, T b, T c) {
  return std::fma(-a, b, c);
}
inline float roundNearest(float a) { return std::nearbyint(a); }
inline float powerOfTwo(float n) { return std::bit_cast<float>((static_cast<std::int32_t>(n) + 127) << 23); }
inline float sqrt(float a) { return std::sqrt(a); }
inline double sqrt(double a) { return std::sqrt(a); }
template <class T>
inline T select(bool m, T yes, T no) {
  return m ? yes : no;
}
template <class T>
inline T keepIf(bool m, T a) {
  return m ? a : T(0);
}
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline float min(float a, float b) { return a < b ? a : b; }
inline float max(float a, float b) { return a > b ? a : b; }
#endif

// 2^x for x in [-126, 127], relative error below 3e-7: nearest whole power times a polynomial on [-1/2, 1/2].
template <class F>
BEAM_INLINE F exp2(F x) {
  const F n = roundNearest(x), f = x - n;
  F q = fma(F(1.5403530e-4f), f, F(1.3333558e-3f));
  q = fma(q, f, F(9.6181291e-3f));
  q = fma(q, f, F(5.5504109e-2f));
  q = fma(q, f, F(2.4022651e-1f));
  q = fma(q, f, F(6.9314718e-1f));
  q = fma(q, f, F(1.0f));
  return q * powerOfTwo(n);
}

// Natural exponential for |x| < 87.
template <class F>
BEAM_INLINE F exp(F x) {
  return exp2(x * F(1.44269504f));
}

BEAM_KERNELS_END
#endif
