// SPDX-License-Identifier: Apache-2.0
// Words of the command line that choose views and frames of a project.
#pragma once

#include <string>
#include <vector>

#include "core/pipeline/project.h"

namespace beam {

// "test", "train", "all" or camera names with commas. Throws Error{Usage} for an unknown name or an empty
// choice.
std::vector<ViewIndex> selectViews(const std::string& words, const CaptureSet& capture);

// "all": every frame with Gaussians, `interpolated` ones too where that is true; else a frame list. Throws
// Error{Data} when nothing is solved.
std::vector<FrameIndex> selectSolvedFrames(const std::string& list, const Project& project,
                                           bool interpolated = false);

}  // namespace beam
