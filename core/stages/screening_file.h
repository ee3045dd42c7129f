// SPDX-License-Identifier: Apache-2.0
// screening.json, the file of capture.screen: which cameras the fit of a frame goes without, and why.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/method/screen_views.h"

namespace beam {

struct FrameScreening {
  bool enabled = true;
  std::size_t cameras = 0;             // with a readable picture, for training
  std::vector<ScreenedView> left_out;  // sorted by camera
  std::vector<ScreenedView> suspects;  // kept, because leaving them out would leave too few

  bool leavesOut(const std::string& camera) const;
};

// `folder` is the result's. `figures` go into the file for whoever looks, and are not read back.
void writeScreening(const std::filesystem::path& folder, const FrameScreening& screening,
                    const std::vector<ScreenFigures>& figures);
// Throws Error{Data} naming a file that cannot be understood.
FrameScreening readScreening(const std::filesystem::path& folder);

}  // namespace beam
