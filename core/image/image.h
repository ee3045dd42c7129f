// SPDX-License-Identifier: Apache-2.0
// Image<T>: a picture of T, rows top to bottom, no padding. Pixel (x, y) has its centre at (x + 0.5, y +
// 0.5). Planes: the same data as separate float planes, the form that the engine computes on.
#pragma once

#include <cstddef>
#include <vector>

#include "core/math/types.h"

namespace beam {

enum class Encoding {
  Srgb,    // display-referred, sRGB transfer function
  Linear,  // scene-linear Rec.709
  Data,    // numbers that are no colour
};

template <class T>
struct Image {
  int width = 0, height = 0;
  Encoding encoding = Encoding::Data;
  std::vector<T> pixels;  // width * height

  Image() = default;
  Image(int w, int h, T fill = T{}, Encoding e = Encoding::Data)
      : width(w), height(h), encoding(e), pixels(static_cast<std::size_t>(w) * h, fill) {}
  bool empty() const { return pixels.empty(); }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
  T& operator()(int x, int y) { return pixels[index(x, y)]; }
  const T& operator()(int x, int y) const { return pixels[index(x, y)]; }
};

struct Planes {
  int width = 0, height = 0, channels = 0;
  std::vector<float> values;  // [channel][y][x]

  Planes() = default;
  Planes(int w, int h, int c, float fill = 0.0f)
      : width(w), height(h), channels(c), values(static_cast<std::size_t>(w) * h * c, fill) {}
  bool empty() const { return values.empty(); }
  std::size_t planeSize() const { return static_cast<std::size_t>(width) * height; }
  float* plane(int c) { return values.data() + planeSize() * c; }
  const float* plane(int c) const { return values.data() + planeSize() * c; }
};

}  // namespace beam
