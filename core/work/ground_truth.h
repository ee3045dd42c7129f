// SPDX-License-Identifier: Apache-2.0
// Scores of picture folders against a data set's ground truth, by the rules of the data sets' own evaluator.
// The only code of the house that reads gt/.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/work/scores.h"

namespace beam {

struct GroundTruth {
  std::filesystem::path folder;  // the data set's; gt/ lies inside
  std::vector<std::string> test_cameras, frames, gt_frames, environments;
  double unit_m = 1;  // metres a unit of its depth and meshes, and of those that are compared to them
};
// Throws Error{Data} when the folder has no dataset.json or no gt/.
GroundTruth openGroundTruth(const std::filesystem::path& folder);

// Scores what is in `pictures` (missing pictures are left out); throws Error{Data} when nothing can be
// scored. `each` also gets every picture's own scores.
ScoreTable scorePictures(const GroundTruth& truth, const std::filesystem::path& pictures, Progress& progress,
                         PictureScores& each);

}  // namespace beam
