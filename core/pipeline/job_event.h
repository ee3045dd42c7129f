// SPDX-License-Identifier: Apache-2.0
// What a run tells the world. The console and the studio are two readers of the same stream.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/progress.h"
#include "core/pipeline/step_id.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/ids.h"

namespace beam {

// Which piece of work an event is about. `frame` is absent for steps that serve the whole project.
struct StepRef {
  StepId step;
  std::optional<FrameIndex> frame;
  std::string frame_name;  // the capture's own; empty without frame
  bool lead = false;       // of a frame that is only there for the take after it to build on (Take::lead)
};

// Gaussians as the step at work has them, to look at; not an event: only the newest counts.
struct JobPreview {
  StepRef ref;
  std::shared_ptr<const GaussianCloud> cloud;
};

struct StageStarted {
  std::string stage;  // "surface"
  std::optional<FrameIndex> frame;
  std::string frame_name;
};

struct StepProgress {
  StepRef ref;
  ProgressReport report;                                 // of this step
  double job_fraction = 0;                               // of the whole run, [0, 1]
  double seconds_elapsed = 0;                            // of the whole run
  double seconds_left = -1;                              // of the whole run, estimated; < 0: not known yet
  double seconds_left_low = -1, seconds_left_high = -1;  // between these it is likely to be
  double rate = 0;                                       // report.done a second, lately; 0: not known yet
  // What the counter and the rate beside it say of the seconds left; seconds_left is never below.
  double countedLeft() const { return rate > 0 ? static_cast<double>(report.total - report.done) / rate : 0; }
};

// Sent after the result is on disk for good: what is acknowledged here survives a kill.
struct StepFinished {
  StepRef ref;
  Digest key;
  bool reused = false;  // it was there already
  double seconds = 0;
};

// One frame gave up; the run goes on with the others.
struct StepFailed {
  StepRef ref;
  std::string message;
};

struct JobWarning {
  std::string text;
};

// The run rests until another process has published this result; told when that begins and when it becomes
// another result or process.
struct JobWaiting {
  StepRef ref;
  std::string holder;  // "process 1234"
};

enum class JobOutcome {
  Done,
  DoneWithFailures,  // some frames failed; they are listed
  Cancelled,
  Failed,  // `kind` and `message` tell why
};

struct JobFinished {
  JobOutcome outcome = JobOutcome::Done;
  Error::Kind kind = Error::Kind::Bug;  // of a failed job
  std::string message;                  // of a failed job
  std::vector<StepFailed> failed;       // frames
  int frames = 0;                  // that were to be done, without leads; 0: it ended before that was known
  std::vector<std::string> notes;  // what was left out and what it would need
  int computed = 0, reused = 0;    // steps
  double seconds = 0;
  bool at_rest = false;  // cancelled between two steps as asked (StopAfter); the last note says after which
};

using JobEvent =
    std::variant<StageStarted, StepProgress, StepFinished, StepFailed, JobWarning, JobWaiting, JobFinished>;

}  // namespace beam
