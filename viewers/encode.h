// SPDX-License-Identifier: Apache-2.0
// Linear light to 8-bit sRGB by table: pow for each pixel would cost more than the rest of a redraw. Within
// one level of the exact curve.
#pragma once

#include <algorithm>
#include <vector>

#include "core/math/color.h"

namespace beam {

class SrgbEncoder {
 public:
  static const SrgbEncoder& instance() {
    static const SrgbEncoder encoder;
    return encoder;
  }
  std::uint8_t operator()(float linear) const {
    return linear > 0 ? table_[static_cast<int>(std::min(linear, 1.0f) * kLast + 0.5f)] : 0;
  }
  u8vec3 operator()(vec3 linear) const { return {(*this)(linear.x), (*this)(linear.y), (*this)(linear.z)}; }

 private:
  static constexpr int kLast = 16383;
  SrgbEncoder() : table_(kLast + 1) {
    for (int i = 0; i <= kLast; ++i) {
      table_[i] = static_cast<std::uint8_t>(255 * srgbFromLinear(static_cast<float>(i) / kLast) + 0.5f);
    }
  }
  std::vector<std::uint8_t> table_;
};

}  // namespace beam
