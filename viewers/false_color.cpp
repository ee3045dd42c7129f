// SPDX-License-Identifier: Apache-2.0
#include "viewers/false_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/math/color.h"

namespace beam {
namespace {

// OKLab to linear Rec.709 (Ottosson 2020).
vec3 linearFromOklab(vec3 lab) {
  const float l = lab.x + 0.3963377774f * lab.y + 0.2158037573f * lab.z;
  const float m = lab.x - 0.1055613458f * lab.y - 0.0638541728f * lab.z;
  const float s = lab.x - 0.0894841775f * lab.y - 1.2914855480f * lab.z;
  const float l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
  return {4.0767416621f * l3 - 3.3077115913f * m3 + 0.2309699292f * s3,
          -1.2684380046f * l3 + 2.6097574011f * m3 - 0.3413193965f * s3,
          -0.0041960863f * l3 - 0.7034186147f * m3 + 1.7076147010f * s3};
}

// Indigo through teal to yellow: lightness 0.28 to 0.93 in even steps, hue from 290 to 105 degrees.
std::array<u8vec3, 256> makeMap() {
  std::array<u8vec3, 256> map;
  for (int i = 0; i < 256; ++i) {
    const float t = static_cast<float>(i) / 255;
    const float hue = (290 - 185 * t) * kPi / 180, chroma = 0.11f + 0.05f * t;
    const vec3 linear = linearFromOklab({0.28f + 0.65f * t, chroma * std::cos(hue), chroma * std::sin(hue)});
    map[i] = u8vec3(255.0f * srgbFromLinear(glm::clamp(linear, vec3(0), vec3(1))) + 0.5f);
  }
  return map;
}

}  // namespace

u8vec3 falseColor(float t) {
  static const std::array<u8vec3, 256> map = makeMap();
  return map[t > 0 ? static_cast<int>(std::min(t, 1.0f) * 255 + 0.5f) : 0];
}

Limits robustLimits(std::span<const float> values) {
  std::vector<float> positive;
  positive.reserve(values.size());
  for (const float v : values) {
    if (v > 0) positive.push_back(v);
  }
  if (positive.empty()) return {};
  const auto at = [&](double share) {
    const auto nth =
        positive.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(positive.size() - 1));
    std::nth_element(positive.begin(), nth, positive.end());
    return *nth;
  };
  const Limits limits{at(0.01), at(0.99)};
  return limits.high > limits.low ? limits : Limits{limits.low, limits.low * 1.001f + 1e-6f};
}

}  // namespace beam
