// SPDX-License-Identifier: Apache-2.0
// What a take lost by the cameras that were left out of the fit of some of its frames (screen_views.h): said
// as far as scores of solved frames show it, without a second fit.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/method/find_defects.h"
#include "core/method/screen_views.h"

namespace beam {

// One camera, over the frames it was left out of.
struct LeftOutCamera {
  std::string camera;
  ScreenKind kind = ScreenKind::Black;
  std::vector<std::string> frames;  // in order
  std::vector<int> indices;         // of the frames, in the capture
  std::string text;                 // of the frame with the greatest figure
  double figure = 0;
};

struct ScreenedFrame {
  std::string name;
  int index = 0;
  std::vector<ScreenedView> left_out;
};

// Sorted by camera, then kind.
std::vector<LeftOutCamera> collectLeftOut(std::span<const ScreenedFrame> frames);

// "camera cam03 in frames 000003-000007: has an outline ...; it is 3 frames late"; the moment comes from the
// scores of solved frames, where the screening saw only the outline.
std::string toText(const LeftOutCamera& camera, std::span<const Defect> defects);

// Means over frames of the means over views, psnr in dB.
struct FitQuality {
  int frames = 0, held_out_frames = 0;  // that have a fitted, a held-out view
  double fitted = 0, held_out = 0;
};
struct LeftOutLoss {
  FitQuality incomplete, complete;  // frames with a camera left out; the others
  int least_fitted = 0, of = 0;     // views of the incomplete frame that has the fewest; its views in all
};
LeftOutLoss lossOf(std::span<const ScoredFrame> frames);
// Empty when no scored frame is incomplete.
std::string toText(const LeftOutLoss& loss);

}  // namespace beam
