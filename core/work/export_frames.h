// SPDX-License-Identifier: Apache-2.0
// A project's frames as splat files for other programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/pipeline/project.h"

namespace beam {

// A format of which every frame is a file of its own: OUT/frame.000000.EXTENSION.
struct ExportFormat {
  std::string id;         // as typed
  std::string extension;  // without the dot
  std::string help;       // one line
};
const std::vector<ExportFormat>& exportFormats();

struct ExportRequest {
  Project project;
  std::string frames = "all";  // of selectSolvedFrames; those between the ones of a scout too
  bool world_frame = false;    // world axes and metres instead of the capture's
  std::filesystem::path out;   // a folder; made when it is not there
  std::string format = "ply";  // of exportFormats()
  bool force = false;          // of OutputRule
  bool strict = false;         // of WantedResults
};

struct ExportOutcome {
  std::vector<std::filesystem::path> files;  // one a frame, in order
  std::vector<std::string> interpolated;     // names of those frames that are interpolated, not solved
};

// Throws Error{Usage} for words that choose nothing, an unknown format and a place that requireFolderTarget
// refuses, Error{Data} for a frame without
// Gaussians, Error{Storage}, Cancelled: whole files are left then, of the frames that were done.
ExportOutcome exportFrames(const ExportRequest& request, Progress& progress);

}  // namespace beam
