// SPDX-License-Identifier: Apache-2.0
// Whether the masks of a frame can be outlines of one body at one moment (silhouette consistency): needs no
// picture, no other frame and no fit.
#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/frame_views.h"

namespace beam {

struct OutlineFit {
  // Share of the view's mask that nothing can lie behind: at every place on these rays some other view sees
  // background; not where the subject's depth is in no other picture.
  double contradicted = 0;
  // Contradictions of all views, in shares of their masks, that are put down to this view: it and the
  // `most_wrong` views at most that deny the least denied place share one evenly; where more deny, it is its.
  double blame = 0;
};

// One a view; zeros for a view without a mask. Masks may be off by about two hundredths of the subject's
// size.
// `most_wrong`: 0 to VisualHull::kMostDenials; 0 is quick and tells contradictions, but not whose they are.
std::vector<OutlineFit> compareOutlines(std::span<const FrameView> views, int most_wrong,
                                        const Progress& progress);

}  // namespace beam
