// SPDX-License-Identifier: Apache-2.0
// How far two pictures are apart: a number a pixel, and what they come to. Pure: equal inputs, equal outputs,
// and no matter which of the two is A.
#pragma once

#include <optional>
#include <string>

#include "viewers/image/picture.h"

namespace beam {

struct Difference {
  // One channel in false colours. Colours: |A − B| in sRGB-encoded values, mean of the channels. Directions:
  // the angle between them in degrees. Other numbers: |A − B|. NaN where one of the two has nothing.
  Picture map;
  Image<std::uint8_t> counted;    // 255: in the figures; empty: every pixel that has a number
  std::size_t pixels = 0;         // in the figures
  double mean = 0;                // of the map
  std::optional<double> psnr_db;  // of colours and of shares of 1, from all channels; none when identical
  bool identical = false;
};

// Why there is no difference of the two, a sentence; empty: there is one.
std::string incomparable(const Picture& a, const Picture& b);

// `mask`: figures are of its pixels from 128 on; empty: of all. Throws Error{Data} with the sentence of
// incomparable(), or when the mask has another size than the pictures.
Difference differenceOf(const Picture& a, const Picture& b, Image<std::uint8_t> mask = {});

// From 0 to what leaves out the highest hundredth of the counted values; never empty.
Limits limitsOf(const Difference& difference);

// sRGB, opaque; what is not counted is darkened.
Image<u8vec4> displayed(const Difference& difference, const Limits& limits);

// "PSNR 31.25 dB · mean 0.0123 · over the mask, 12,345 pixels"
std::string describe(const Difference& difference);

}  // namespace beam
