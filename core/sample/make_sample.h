// SPDX-License-Identifier: Apache-2.0
// A synthetic dome capture of our own making, with full ground truth, in the layout of the data sets
// (dataset.json, transforms.json, sparse/, images, masks, environment, gt). The demo and the tests use it.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/progress.h"
#include "core/sample/defects.h"

namespace beam {

struct SampleOptions {
  int frames = 1;        // at 30 a second; from two on the figure moves (motion.h)
  int cameras = 12;      // for training, in three rings around the figure
  int test_cameras = 2;  // held out, with ground truth
  int width = 240, height = 320;
  int samples = 48;  // light paths a pixel
  int seed = 1;
  std::vector<SampleDefect> defects = {};  // of training cameras
};

// Writes into `folder`, which must not exist or be empty, and whose cameras the defects name: Error{Usage}
// otherwise. The same bytes for any
// number of threads.
void makeSample(const std::filesystem::path& folder, const SampleOptions& options, Progress& progress);

}  // namespace beam
