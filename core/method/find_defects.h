// SPDX-License-Identifier: Apache-2.0
// Finds cameras and moments of a capture that do not fit the others, from the scores of solved frames; needs
// no truth. Every rule compares a camera with the other cameras of the same frame, so that a dark scene or a
// soft subject accuses nobody. Lateness takes at least three frames in a row and is said of at most half of
// the cameras. Pure functions of the scores.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/method/score_views.h"

namespace beam {

struct ScoredFrame {
  std::string name;
  int index = 0;  // in the capture; neighbours in time differ by one
  std::span<const ViewScore> views;
  std::vector<std::string> missing;  // cameras of the capture without a readable picture
  int missing_training = 0;          // how many of them are no test cameras
};

enum class DefectKind { Missing, Black, Frozen, Blurred, Late, Exposure };
const char* toText(DefectKind kind);  // "blurred"

struct Defect {
  DefectKind kind = DefectKind::Missing;
  std::string camera;
  std::vector<std::string> frames;  // in order
  // Black: luma; Blurred: share of the usual sharpness; Exposure: factor; Late: frames (negative: early; of a
  // training camera a lower bound); Missing, Frozen: count.
  double figure = 0;
  std::string text;  // a sentence with the figure, and what to do
  // Mean psnr in dB of the training views of these frames, with and without this camera; equal when the
  // camera has no scored picture there or nobody else has.
  double psnr_with = 0, psnr_without = 0;
};

struct DefectLimits {
  double black_luma = 0.02;    // a picture whose subject is darker, while the render is brighter than thrice
  double blurred_share = 0.6;  // photo/render sharpness against the median camera of the frame
  double exposure_factor = 1.2;  // photo/render luma against the median camera, or its inverse
  int most_late = 6;             // frames a camera may be off
  double late_gain = 0.8;        // the difference to the better moment against that to its own
};

// `frames` in order of time. Sorted by camera, then kind.
std::vector<Defect> findDefects(std::span<const ScoredFrame> frames, const DefectLimits& limits = {});

}  // namespace beam
