// SPDX-License-Identifier: Apache-2.0
// Pictures and meshes of a project's frames as files, laid out as renderChannels writes them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/pipeline/project.h"
#include "core/render/scene_renderer.h"

namespace beam {

struct RenderFramesRequest {
  Project project;
  std::vector<std::string> channels = {"rgb"};  // ids of scene/channel.h
  std::string cameras = "test";                 // of selectViews
  std::string frames = "all";  // of selectSolvedFrames; those between the ones of a scout too
  std::vector<std::filesystem::path> environments;  // for "relight"
  std::optional<ivec2> size = {};  // of the pictures, in pixels; none: that of each camera (fittedTo)
  bool world_frame = false;    // normals, depth and meshes in world axes and metres instead of the capture's
  bool layers = false;         // of RenderRequest
  bool skip_existing = false;  // likewise
  std::filesystem::path out;
  bool force = false;   // of OutputRule
  bool strict = false;  // of WantedResults
};

struct RenderFramesOutcome {
  std::size_t cameras = 0, frames = 0;    // that were asked for
  std::vector<std::string> interpolated;  // names of those frames that are interpolated, not solved
  std::size_t written = 0, kept = 0;      // files; kept: skip_existing found them
};

// Throws Error{Usage} for words that choose nothing and a place that requireFolderTarget refuses, Error{Data}
// when a frame is not solved as far as a channel needs, Error{Storage}, Cancelled: whole files are left then,
// of the pictures that were done.
RenderFramesOutcome renderFrames(const RenderFramesRequest& request, SceneRenderer& renderer,
                                 Progress& progress);

}  // namespace beam
