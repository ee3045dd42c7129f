// SPDX-License-Identifier: Apache-2.0
// Pictures of a project's frames as a look shows them: OUT/look_<name>/<camera>/<frame>.png, or .exr where
// the look's view transform is raw.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/pipeline/project.h"
#include "core/render/scene_renderer.h"
#include "core/scene/look.h"

namespace beam {

struct ChosenLook {
  Look look;                     // with a name that is one
  std::filesystem::path folder;  // that its references are relative to
};
// `words`: the name of a look of the project, else a file; one without a name takes the file's. Throws
// Error{Usage} where it is neither, and what parseLook throws.
ChosenLook chosenLook(const Project& project, const std::string& words);

struct RenderLookRequest {
  Project project;
  ChosenLook look;
  std::string cameras = "test";    // of selectViews
  std::string frames = "all";      // of selectSolvedFrames
  std::optional<ivec2> size = {};  // as of RenderFramesRequest
  std::filesystem::path out;
  bool force = false;   // of OutputRule
  bool strict = false;  // of WantedResults
};

struct RenderLookOutcome {
  std::string folder;  // below `out`
  std::size_t cameras = 0, frames = 0;
  std::vector<std::string> interpolated;
};

// A frame is lit as the look is at its time: its place in the capture over the rate. Logs what of the look
// has no effect. Throws Error{Usage} for words that choose nothing, a view transform that is not drawn, a
// look in which nothing shines, and a place that requireFolderTarget refuses; Error{Data} when a frame has no
// materials or the panorama is gone; Error{Storage}, Cancelled: the pictures that were done are left, whole.
RenderLookOutcome renderLook(const RenderLookRequest& request, SceneRenderer& renderer, Progress& progress);

}  // namespace beam
