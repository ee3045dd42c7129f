// SPDX-License-Identifier: Apache-2.0
// Events of a run -> JSON on standard output, one object a line, for programs that wait for a run.
#pragma once

#include <chrono>

#include "app/cli/console.h"
#include "core/pipeline/job_event.h"

namespace beam {

// Each line has "event": "stage", "progress", "step", "step_failed", "warning", "waiting" or "finished"; the
// last one is "finished" with the exit code. Progress comes ten times a second at most.
class JsonReporter {
 public:
  explicit JsonReporter(Console& console) : console_(console) {}
  // Throws Error{Storage} when standard output does not take it.
  void report(const JobEvent& event);

 private:
  Console& console_;
  std::chrono::steady_clock::time_point last_progress_{};
};

}  // namespace beam
