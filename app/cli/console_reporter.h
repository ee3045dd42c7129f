// SPDX-License-Identifier: Apache-2.0
// Events of a run -> terminal: one line a finished step, a bar for the step at work, a summary at the end.
#pragma once

#include <string>

#include "app/cli/console.h"
#include "core/pipeline/job_event.h"

namespace beam {

class ConsoleReporter {
 public:
  explicit ConsoleReporter(Console& console) : console_(console) {}
  void report(const JobEvent& event);

 private:
  void show(const StageStarted& event);
  void show(const StepProgress& event);
  void show(const StepFinished& event);
  void show(const StepFailed& event);
  void show(const JobWarning&) {}  // the console hears warnings itself, also those outside of runs
  void show(const JobWaiting& event);
  void show(const JobFinished& event);

  Console& console_;
};

// Exit code of a run: 0 done, 10 some frames failed, 75 interrupted and resumable, else of the failure.
int exitCode(const JobFinished& finished);

}  // namespace beam
