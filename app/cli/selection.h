// SPDX-License-Identifier: Apache-2.0
// Words of the command line that choose views of a capture and frames of a sequence.
#pragma once

#include <string>
#include <vector>

#include "core/scene/capture.h"
#include "core/scene/gaussian_sequence.h"

namespace beam {

// "test", "train", "all" or camera names with commas. Throws Error{Usage} for an unknown name or an empty
// choice.
std::vector<View> selectViews(const std::string& words, const CaptureSet& capture);

// "all": every frame with Gaussians; else a frame list. Throws Error{Data} when nothing is solved.
std::vector<FrameIndex> selectSolvedFrames(const std::string& list, const GaussianSequence& sequence);

}  // namespace beam
