// SPDX-License-Identifier: Apache-2.0
// Numbers as colours: one perceptual map for every view, with limits. Lightness grows evenly, so the map
// reads in grey and without colour vision.
#pragma once

#include <span>

#include "core/math/types.h"

namespace beam {

struct Limits {
  float low = 0, high = 1;
};

// sRGB colour of t; t is clamped to [0, 1], NaN counts as 0.
u8vec3 falseColor(float t);
inline u8vec3 falseColor(float value, const Limits& limits) {
  return falseColor((value - limits.low) / (limits.high - limits.low));
}

// Limits that leave out the lowest and highest hundredth of the positive values; {0, 1} when there are none.
// Never empty: high > low.
Limits robustLimits(std::span<const float> values);

}  // namespace beam
