// SPDX-License-Identifier: Apache-2.0
// Where kernel formulas live. A plain template of Highway vectors in an ordinary header will not do: GCC
// refuses it at -O2 and is silently wrong at -O0. A file that defines BEAM_KERNELS_SIMD and includes
// hwy/foreach_target.h reads every kernel header once an instruction set, in beam::<target>; any other file
// reads it once, in beam::scalar, with plain floats, doubles or arrays.
#include <bit>
#include <cmath>
#include <cstdint>

#if defined(__GNUC__) && !defined(__clang__) && !defined(__OPTIMIZE__) && defined(BEAM_KERNELS_SIMD)
#error "SIMD kernels need optimisation: build with -Og, -O1 or more"
#endif

#undef BEAM_KERNELS_BEGIN
#undef BEAM_KERNELS_END
#undef BEAM_KERNELS_VECTOR
#undef BEAM_INLINE
#undef BEAM_KERNELS_PASS

#ifdef BEAM_KERNELS_SIMD
#include "hwy/highway.h"
#define BEAM_KERNELS_BEGIN \
  HWY_BEFORE_NAMESPACE();  \
  namespace beam {         \
  namespace HWY_NAMESPACE {
#define BEAM_KERNELS_END \
  }                      \
  }                      \
  HWY_AFTER_NAMESPACE();
#define BEAM_INLINE HWY_INLINE
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3
#define BEAM_KERNELS_VECTOR 1
#else
#define BEAM_KERNELS_VECTOR 0
#endif
#else
#define BEAM_KERNELS_BEGIN \
  namespace beam {         \
  namespace scalar {
#define BEAM_KERNELS_END \
  }                      \
  }
#define BEAM_INLINE inline
#define BEAM_KERNELS_VECTOR 0
#endif
