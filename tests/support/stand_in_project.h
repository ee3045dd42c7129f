// SPDX-License-Identifier: Apache-2.0
// A project over stand-ins: a take of small frames in memory, of a sphere that moves and turns, and stages
// that finish at once, or wait as long as a test wants. For tests of what is made of solved frames, and of
// the window, not of how frames are solved.
#pragma once

#include <filesystem>
#include <memory>

#include "core/pipeline/project.h"
#include "core/pipeline/run_plan.h"

namespace beam::testing {

struct StandInSize {
  int cameras = 4;   // cam0, cam1, ...
  int held_out = 1;  // of them, the last ones
  int frames = 6;    // 000000, 000001, ...
  int size_px = 96, gaussians = 60;
  const char* name_end = "";  // of frames, after the number
};

// The capture is any folder that exists; pictures of every camera and frame differ.
std::shared_ptr<const PipelineSetup> standInPipeline(const StandInSize& size = {});
// Steps of surface.fit wait from now on until they are let go, or are cancelled.
void holdStandInRuns(bool hold);
// Makes `folder`/capture and `folder`/capture.beam, where nothing is solved.
Project newStandIn(const std::filesystem::path& folder, const StandInSize& size = {});
// Likewise, with what `request` says solved: every frame.
Project solvedStandIn(const std::filesystem::path& folder, const StandInSize& size = {},
                      const RunRequest& request = {});
// The saved project with what is missing of it, as solvedStandIn leaves one.
Project solvedAgain(const Project& project, const StandInSize& size = {}, const RunRequest& request = {});

}  // namespace beam::testing
