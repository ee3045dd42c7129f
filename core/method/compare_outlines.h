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
  // Share of the view's mask that nothing can lie behind: more other views than are likely to be wrong deny
  // every place on these rays.
  double denied = 0;
  // What the view alone denies and the others agree upon: mean over the other views, share of their masks.
  double alone = 0;
  bool judged = false;  // false: the view has no mask, or nothing of it is in the common space
};

// One a view. Masks may be off by about two hundredths of the subject's size.
std::vector<OutlineFit> compareOutlines(std::span<const FrameView> views, const Progress& progress);

}  // namespace beam
