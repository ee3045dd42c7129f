// SPDX-License-Identifier: Apache-2.0
// Scores of a solved frame's render against its photographs, camera by camera; needs no truth. The rules are
// those of evaluate.h: bounding box of the mask, sRGB-encoded colours rounded to 8 bits, black background.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/method/evaluate.h"
#include "core/render/device.h"
#include "core/scene/frame_views.h"
#include "core/scene/gaussian_cloud.h"

namespace beam {

inline constexpr int kThumbSide_px = 64;

// Lumas are sRGB-encoded, Rec.709 weights, [0, 1]; means are over the mask.
struct ViewScore {
  std::string camera;
  bool held_out = false;
  bool left_out = false;  // a training camera that the frame was fitted without; of neither split
  PictureScore score;
  double photo_luma = 0, render_luma = 0;            // mean
  double photo_sharpness = 0, render_sharpness = 0;  // mean |4 v - sum of the four neighbours|
  // Luma of the whole picture over the subject's background, black elsewhere, scaled down by one whole factor
  // to fit kThumbSide_px squared (block means; the rest is 0): enough to tell moments apart.
  Image<std::uint8_t> photo_thumb, render_thumb;
};

// `views` at the resolution that counts; an empty mask counts every pixel.
std::vector<ViewScore> scoreViews(std::span<const FrameView> views, bool held_out, const GaussianCloud& cloud,
                                  ComputeDevice& device, Progress& progress);

// Means over the cameras of one split, and the worst camera by psnr; n = 0: there is none.
struct SplitScore {
  PictureScore mean;
  std::size_t n = 0, worst = 0;  // worst: index in the scores
};
SplitScore meanOf(std::span<const ViewScore> scores, bool held_out);

}  // namespace beam
