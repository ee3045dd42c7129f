// SPDX-License-Identifier: Apache-2.0
// Cameras of one frame that would spoil its fit, found before it: black, blurred, or with an outline that the
// others contradict (another moment, a moved camera, a wrong mask). Every rule compares a camera with the
// other cameras of the frame, so that a dark scene or a soft subject accuses nobody. Looks at no other frame;
// what needs the take or the fit is find_defects.h's.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/frame_views.h"

namespace beam {

// With a margin of about two on either side of good captures (rendered and photographed) and spoiled ones.
struct ScreenLimits {
  // The bright part of a black picture: at most, and as a share of the median camera's.
  double black_luma = 0.03, black_share = 0.15;
  double blurred_share = 0.55;  // fine detail against the median camera's
  // Share of the masks that contradicts the others, mean over the views: at least, and what may remain of it
  // without the suspects.
  double outline_share = 0.006, outline_rest = 0.25;
};

enum class ScreenKind { Black, Blurred, Outline };
const char* toText(ScreenKind kind);  // "blurred"

// What of a view the rules look at; luma is sRGB-encoded.
struct ScreenFigures {
  std::string camera;
  double bright = 0;  // luma that one pixel in twenty inside the mask exceeds; without a mask one in 1000
  // Gradients at a hundredth of the subject's size against those at four; 0: there is nothing to judge.
  double detail = 0;
  double outline = 0;  // share of its mask that other masks contradict
};

struct ScreenedView {
  std::string camera;
  ScreenKind kind = ScreenKind::Black;
  double figure = 0;  // Black: bright; Blurred: share of the usual detail; Outline: fall of
                      // the contradicted share of the masks without it
  std::string text;   // a sentence after the camera's name
};

struct Screening {
  std::vector<ScreenFigures> figures;  // by view
  std::vector<ScreenedView> suspects;  // black, then outline, then blurred: the harm they do
  // The first so many are to be left out: all, unless they are more than a quarter of the views or fewer than
  // three would remain; then all that are not blurred, under the same rule; else none.
  std::size_t to_leave_out = 0;
};

Screening screenViews(std::span<const FrameView> views, const ScreenLimits& limits, const Progress& progress);

}  // namespace beam
