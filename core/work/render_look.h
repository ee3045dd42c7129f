// SPDX-License-Identifier: Apache-2.0
// Pictures of a project's frames, or of a scene file, as a look shows them: of the capture's cameras as
// OUT/look_<name>/<camera>/<frame>.png, of one that moves as OUT/look_<name>/<path>/000000.png and as the
// film OUT/look_<name>/<path>.mp4. In place of .png .exr where the look's view transform is raw, without a
// film.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/pipeline/project.h"
#include "core/render/scene_renderer.h"
#include "core/work/look_scene.h"
#include "core/work/look_shots.h"

namespace beam {

struct RenderLookRequest {
  Project project;
  ChosenLook look;
  std::string cameras =
      "test";  // of selectViews; a film has the size of the first, and of a turntable its place
  std::string frames = "all";      // of selectSolvedFrames
  std::optional<ivec2> size = {};  // as of RenderFramesRequest
  std::string camera_path = {};    // of chosenPath
  FilmTiming timing = {};
  std::filesystem::path out;
  bool force = false;   // of OutputRule
  bool strict = false;  // of WantedResults
};

struct RenderLookOutcome {
  std::string folder;                   // below `out`
  std::size_t cameras = 0, frames = 0;  // of the capture; of a film no cameras
  std::size_t pictures = 0;
  std::string film = {};  // its file below `out`; empty: there is none
  std::vector<std::string> interpolated;
};

// Logs what of the look has no effect, and what of the scene is not seen as it is meant. Throws Error{Usage}
// for words that choose nothing, a view transform that is not drawn, a look in which nothing shines, and a
// place that requireFolderTarget refuses; Error{Data} when a frame has no materials or the panorama is gone;
// Error{Storage}, Cancelled: the pictures that were done are left, whole, and no film.
RenderLookOutcome renderLook(const RenderLookRequest& request, SceneRenderer& renderer, Progress& progress);

}  // namespace beam
