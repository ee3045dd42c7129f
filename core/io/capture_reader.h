// SPDX-License-Identifier: Apache-2.0
// Opens a capture folder: dataset.json, then transforms.json, then sparse/ (contract: import). Read-only.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/capture.h"

namespace beam {

struct ImportOptions {
  std::optional<UpAxis> up = {};           // overrides what the capture says
  std::vector<std::string> hold_out = {};  // camera names, or one number N: every Nth camera
};

struct ImportedCapture {
  CaptureSet set;
  std::string layout;                 // "dataset.json", "transforms.json", "COLMAP text", "COLMAP binary"
  std::vector<std::string> warnings;  // each a whole sentence; also logged
};

// Throws Error{Data} when nothing usable is there; a damaged part that can be left out is left out with a
// warning.
ImportedCapture openCapture(const std::filesystem::path& folder, const ImportOptions& options = {});

}  // namespace beam
