// SPDX-License-Identifier: Apache-2.0
// Scores of rendered pictures against ground truth, or of held-out photographs; the rules are those of the
// data sets' own evaluator: bounding box of the mask, sRGB-encoded colours, black background.
#pragma once

#include <optional>
#include <span>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/scene/mesh.h"

namespace beam {

struct PictureScore {
  double psnr = 0;
  std::optional<double> ssim = {};  // none: the picture is smaller than a window of it
  double psnr_mask = 0;
};

// Of ssim over those that have one.
PictureScore meanOf(std::span<const PictureScore> scores);

// Values in [0, 1] in the compared space; a mask is inside from kInside on. Of no meaning when a stop is
// requested.
PictureScore scorePicture(const Planes& prediction, const Planes& truth, const Image<std::uint8_t>& mask,
                          const Progress& progress = Progress());

// Mean angle in degrees inside the mask where the truth has a normal; a missing prediction counts 90.
double normalErrorDeg(const Planes& prediction, const Planes& truth, const Image<std::uint8_t>& mask);

// Mean absolute error in millimetres inside the mask where the truth has a depth.
double depthErrorMm(const Planes& prediction, const Planes& truth, const Image<std::uint8_t>& mask);

struct Chamfer {
  double chamfer_mm = 0, prediction_to_truth_mm = 0, truth_to_prediction_mm = 0;
};
// 100,000 area-uniform points each way, exact point-triangle distances; deterministic. Of no meaning when a
// stop is requested.
Chamfer chamferDistance(const Mesh& prediction, const Mesh& truth, const Progress& progress = Progress());

}  // namespace beam
