// SPDX-License-Identifier: Apache-2.0
// Scores of pictures, in the evaluator's sense: values in [0, 1], crop given by a rectangle, double
// precision.
#pragma once

#include <optional>

#include "core/base/progress.h"
#include "core/image/image.h"

namespace beam {

struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // half-open
};

// 10 log10(1 / mean squared difference) over all channels and pixels of the rectangle; 100 when equal.
double psnr(const Planes& a, const Planes& b, PixelRect rect);

inline constexpr int kSsimWindow_px = 11;

// Wang et al. 2004: 11x11 Gaussian window, sigma 1.5, K = (0.01, 0.03), windows fully inside the rectangle,
// mean over channels; none where the rectangle is narrower or lower than a window. Of no meaning when a stop
// is requested.
std::optional<double> ssim(const Planes& a, const Planes& b, PixelRect rect,
                           const Progress& progress = Progress());

// Bounding box of mask > 0, grown on both sides to a window of ssim(), or to the picture where that is
// smaller. Throws Error{Data} for an empty mask.
PixelRect maskBounds(const Image<std::uint8_t>& mask);

}  // namespace beam
