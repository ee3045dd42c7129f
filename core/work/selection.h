// SPDX-License-Identifier: Apache-2.0
// Words that choose views of a capture and frames of a sequence, as the command line has them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/capture.h"
#include "core/scene/gaussian_sequence.h"

namespace beam {

// The words that hold where nobody says any: test, or all where no camera is held out.
std::string usualCameras(const CaptureSet& capture);

// "test", "train", "all", camera names and patterns ("cam0*") in any mixture, with commas; each view once, in
// the order of the words. Throws Error{Usage} for a word that chooses none and an empty choice.
// With a `size` their pictures have it (fittedTo).
std::vector<View> selectViews(const std::string& words, const CaptureSet& capture,
                              std::optional<ivec2> size = {});

// "all": every frame with Gaussians; else a frame list. Throws Error{Data} when nothing is solved, Cancelled:
// what there is of a frame may hang on pictures whose digests are not known yet.
std::vector<FrameIndex> selectSolvedFrames(const std::string& list, const GaussianSequence& sequence,
                                           const Progress& progress);

// Names of those of the frames that are interpolated.
std::vector<std::string> interpolatedOf(const GaussianSequence& sequence,
                                        const std::vector<FrameIndex>& frames);

}  // namespace beam
