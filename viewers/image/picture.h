// SPDX-License-Identifier: Apache-2.0
// Picture: a photograph or a 2D map to look at, with what its numbers are; as pixels for the screen and in
// words.
#pragma once

#include <functional>
#include <string>

#include "core/image/image.h"
#include "viewers/false_color.h"

namespace beam {

struct Picture {
  std::string label;  // "camera C03 · photograph"
  Planes values;      // 1 or 3 channels
  Encoding encoding =
      Encoding::Linear;      // Srgb: encoded values in [0, 1]; Data: one channel grey, three a direction
  bool false_color = false;  // one channel, by limits
  float nothing = 0;         // in false colours: the value, beside NaN, that stands for nothing there
  std::string unit;
  // Of a photograph: its mask, read where it is asked for (a background thread); unset: there is none.
  std::function<Image<std::uint8_t>()> mask;
};

// Called on a background thread; throws Error with words for the user.
using PictureLoader = std::function<Picture()>;

Picture pictureOf(const Image<u8vec3>& photo, std::string label);
Picture pictureOf(const Image<std::uint8_t>& mask, std::string label);
Picture pictureOf(const Image<vec3>& image, std::string label);
Picture pictureOf(const Image<float>& image, std::string label);

// sRGB, opaque. `exposure_stops` acts on light and photographs, not on data.
Image<u8vec4> displayed(const Picture& picture, float exposure_stops, const Limits& limits);

// Linear and encoded values of a pixel.
std::string describePixel(const Picture& picture, int x, int y);

}  // namespace beam
