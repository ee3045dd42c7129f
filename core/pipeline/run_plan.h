// SPDX-License-Identifier: Apache-2.0
// Which steps a run takes, for which frames, in which order: decided before the first one starts.
#pragma once

#include <string>
#include <vector>

#include "core/pipeline/project.h"

namespace beam {

struct RunRequest {
  std::vector<FrameIndex> frames;  // empty: all frames of the capture
  std::string stage;               // only this stage and what it needs; empty: every stage
  std::string until;               // the last stage; empty: the last there is
};

struct RunPlan {
  std::vector<std::string> project_steps;  // full ids, in order; once a run
  std::vector<std::string> frame_steps;    // in order; for every frame
  std::vector<FrameIndex> frames;
  std::vector<std::string> notes;  // stages left out, and what they would need
};

// Throws Error{Usage} for unknown stages and Error{Data} when the stage that was asked for by name cannot
// run.
RunPlan makeRunPlan(const Project& project, const RunRequest& request);

}  // namespace beam
