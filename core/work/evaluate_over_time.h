// SPDX-License-Identifier: Apache-2.0
// Scores frame by frame: pictures, and what happens between frames (drift, flicker).
#pragma once

#include <vector>

#include "core/render/device.h"
#include "core/scene/capture.h"
#include "core/scene/gaussian_sequence.h"
#include "core/work/ground_truth.h"

namespace beam {

// Adds to every frame that follows its neighbour, under camera "":
//   "flicker.gaussian_radiance", "flicker.gaussian_base_color"  along tracked Gaussians (evaluate_motion.h)
// and, where `truth` (may be null) has gt/tracks/<frame>.ply (x y z nx ny nz, metres, the capture's axes, the
// same points in all frames):
//   "drift.median_mm", "drift.p95_mm"            against the first frame of the take
//   "flicker.radiance", "flicker.base_color"     along the true points in maps of the test cameras, mean
// A take is a run of neighbouring frames that are tracked. `test_views`: the truth's; unused without one.
void scoreMotion(const GaussianSequence& sequence, const std::vector<View>& test_views,
                 const std::vector<FrameIndex>& frames, const GroundTruth* truth, ComputeDevice& device,
                 Progress& progress, PictureScores& each);

// Means over frames of what scoreMotion found, as rows "drift" and "flicker"; nothing where it found nothing.
ScoreTable motionTable(const PictureScores& each);

}  // namespace beam
