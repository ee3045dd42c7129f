// SPDX-License-Identifier: Apache-2.0
// Which steps a run takes, for which frames, in which order: decided before the first one starts. And which
// takes the frames that it is asked for belong to.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/pipeline/project.h"
#include "core/pipeline/step_times.h"

namespace beam {

struct RunRequest {
  // Each run of consecutive frames is a take. Empty: all frames of the capture, in the takes that are there,
  // lengthened and joined.
  std::vector<FrameIndex> frames = {};
  std::string stage = {};  // only this stage and what it needs; empty: every stage
  std::string until = {};  // the last stage; empty: the last there is
  int every = 1;           // K: only every Kth frame, each building on the one K before
  // Frames that takes of several hold stay in them when all that they build on is solved: the result there is
  // the frame's, and fitted alone it would be another.
  bool keeps_takes = false;
  // Of a whole run: the longest take it makes, 0: no longest; absent: the setting track.segment_frames.
  std::optional<int> segment_frames = {};
  // Of new takes: frames solved before their first; absent: the setting track.overlap.
  std::optional<int> overlap = {};
  // Measured before, for the time that is left; what the project's own records say is added.
  StepTimes times = {};
};

// A frame whose turn it is in a run.
struct Turn {
  FrameIndex frame;
  FrameIndex of;  // the frame whose take it is solved in: itself, or for one before those that the take owns
                  // the first that it owns
  bool lead() const { return frame != of; }
  auto operator<=>(const Turn&) const = default;
};

struct RunPlan {
  std::vector<StepId> project_steps;  // in order; once a run
  std::vector<StepId> frame_steps;    // in order; for every frame
  std::vector<StepId> lead_steps;     // of them, those that later frames build on
  std::vector<Turn> turns;            // take by take, in order
  std::vector<std::string> notes;     // stages left out, and what they would need
};

// Makes the takes of the project those of the request (Project::changeTakes); before makeRunPlan.
void arrangeTakes(Project& project, const RunRequest& request);

// Throws Error{Usage} for unknown stages and Error{Data} when the stage that was asked for by name cannot
// run.
RunPlan makeRunPlan(const Project& project, const RunRequest& request);

}  // namespace beam
