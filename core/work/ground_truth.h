// SPDX-License-Identifier: Apache-2.0
// Scores of picture folders against a data set's ground truth, by the rules of the data sets' own evaluator.
// The only code of the house that reads gt/.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/math/similarity3.h"
#include "core/scene/capture.h"
#include "core/work/scores.h"

namespace beam {

struct GroundTruth {
  std::filesystem::path folder;  // the data set's; gt/ lies inside
  std::vector<std::string> test_cameras, frames, gt_frames, environments;
  double unit_m = 1;  // metres a unit of its depth and meshes
  // From the axes and unit of what is compared to them.
  Similarity3 truth_from_capture = {};
};
// Throws Error{Data} when the folder has no dataset.json or no gt/.
GroundTruth openGroundTruth(const std::filesystem::path& folder);

// Takes unit, origin and scale from the cameras that `capture` and the data set both have, so that a copy of
// the data set in another unit is scored as the original. Axes are the same. With fewer than two cameras, or
// others, both count as the same; of others with a warning.
void align(GroundTruth& truth, const CaptureSet& capture);

// From now on it is of these frames alone. Throws Error{Data} when it is of none of them.
void keepFrames(GroundTruth& truth, const std::vector<std::string>& names);

// Before pictures of these test cameras are drawn to be scored. Throws Error{Data} that names the file where
// a mask is missing or of another size than the camera, and when there is nothing to compare with.
void requireFits(const GroundTruth& truth, const std::vector<View>& views);

// Whether there is a folder of a map that is scored from pictures.
bool hasPictures(const GroundTruth& truth, const std::filesystem::path& pictures);

// Scores what is in `pictures` (missing pictures are left out); throws Error{Data} when nothing can be
// scored. `each` also gets every picture's own scores.
ScoreTable scorePictures(const GroundTruth& truth, const std::filesystem::path& pictures, Progress& progress,
                         PictureScores& each);

}  // namespace beam
