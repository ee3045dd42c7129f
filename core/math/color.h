// SPDX-License-Identifier: Apache-2.0
// sRGB transfer function (IEC 61966-2-1), its slope, Rec.709 luminance and bytes. Scalar, per channel.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/math/types.h"

namespace beam {

inline float linearFromSrgb(float c) {
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}
inline float srgbFromLinear(float c) {
  return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
}
// d srgbFromLinear / dc; weights a linear error as it is seen.
inline float srgbSlope(float c) {
  return c <= 0.0031308f ? 12.92f : 1.055f / 2.4f * std::pow(c, 1 / 2.4f - 1);
}

inline vec3 linearFromSrgb(vec3 c) { return {linearFromSrgb(c.x), linearFromSrgb(c.y), linearFromSrgb(c.z)}; }
inline vec3 srgbFromLinear(vec3 c) { return {srgbFromLinear(c.x), srgbFromLinear(c.y), srgbFromLinear(c.z)}; }
inline float luminance(vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
// The same weights on an encoded pixel, in grey levels.
inline double luma(u8vec3 p) { return 0.2126 * p.x + 0.7152 * p.y + 0.0722 * p.z; }

// [0, 1] as 0 to 255, rounded; beyond is clamped.
inline std::uint8_t byteOf(float v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255.0f));
}

}  // namespace beam
