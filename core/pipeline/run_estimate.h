// SPDX-License-Identifier: Apache-2.0
// What a run would have to do and about how long that takes, before it starts.
#pragma once

#include <string>
#include <vector>

#include "core/pipeline/run_plan.h"

namespace beam {

struct StepEstimate {
  StepId step;
  bool per_frame = true;
  std::vector<std::string> frames;  // with something to compute, by name; of a take's lead too
  int missing = 0, total = 0;       // results
  double seconds_low = 0, seconds_high = 0;
  bool measured = true;  // false: nothing tells how long it takes, the seconds say nothing
};

struct RunEstimate {
  int frames = 0, frames_total = 0;  // with something to compute; in the run
  int steps_missing = 0, steps_total = 0;
  double seconds_low = 0, seconds_high = 0;
  bool measured = false;     // false: of some step nothing tells how long it takes, the seconds say nothing
  bool leaves_take = false;  // a frame of a take of several would be fitted for itself
  std::vector<StepEstimate> steps = {};  // in order, those of the run
  std::vector<std::string> notes = {};   // of RunPlan
};

// Changes nothing, on disk or in `project`: the takes that the run would make are made in a copy. Looks at
// the input files of every frame, so not for the window's thread. Throws like makeRunPlan.
RunEstimate estimateRun(const Project& project, const RunRequest& request, const StepTimes& times);

// What a person should know before the run of named frames begins: that it takes one out of its take; empty:
// nothing. Throws like makeRunPlan.
std::string remarkOfRun(const Project& project, const RunRequest& request);

// What `run --dry-run` says: a line a step with what is missing of it and about how long that takes, then all
// of it together.
std::string toText(const RunEstimate& estimate);
std::string toJson(const RunEstimate& estimate);

}  // namespace beam
