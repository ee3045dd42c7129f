// SPDX-License-Identifier: Apache-2.0
// Opens a capture folder: dataset.json, then transforms.json, then sparse/: what says more comes first.
// Read-only.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/capture_placement.h"

namespace beam {

struct ImportOptions {
  std::optional<UpAxis> up = {};           // overrides what the capture says
  std::vector<std::string> hold_out = {};  // camera names, or one number N: every Nth camera
  std::optional<double> unit_m = {};       // metres a unit; overrides what the capture says
  // As it was found before: nothing of it is asked for again.
  std::optional<CapturePlacement> placement = {};
};

struct ImportedCapture {
  CaptureSet set;
  CapturePlacement placement;         // by which the set was brought into the world
  std::string layout;                 // "dataset.json", "transforms.json", "COLMAP text", "COLMAP binary"
  std::vector<std::string> warnings;  // each a whole sentence; also logged
};

// Whether the folder holds a description that openCapture would read, right or wrong.
bool isCapture(const std::filesystem::path& folder);

// Throws Error{Data} when nothing usable is there; a damaged part that can be left out is left out with a
// warning.
ImportedCapture openCapture(const std::filesystem::path& folder, const ImportOptions& options = {});

}  // namespace beam
