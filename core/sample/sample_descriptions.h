// SPDX-License-Identifier: Apache-2.0
// The description files of a sample capture: dataset.json, transforms.json, COLMAP text, for train and for
// test cameras.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/scene/camera.h"

namespace beam {

struct SampleCamera {
  std::string name;
  bool test = false;
  Camera camera;  // camera_from_world holds camera_from_capture
};

struct SampleDescription {
  int frames, width, height;
  double frames_per_second;
  std::vector<SampleCamera> cameras;
  std::vector<int> truth_frames;
  std::vector<std::string> lights;
  std::vector<std::string> defects;  // "late:cam03"
};

std::string frameName(int frame);  // "000012"
void writeSampleDescriptions(const std::filesystem::path& folder, const SampleDescription& description);

}  // namespace beam
