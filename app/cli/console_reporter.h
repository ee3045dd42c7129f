// SPDX-License-Identifier: Apache-2.0
// Events of a run -> terminal: one line a computed step, a bar for the step at work, at the end one line a
// stage for what was there already, and a summary.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/cli/console.h"
#include "core/pipeline/job_event.h"

namespace beam {

class ConsoleReporter {
 public:
  // `answers`: what a run leaves out is what standard output is for, else it is told as the rest.
  explicit ConsoleReporter(Console& console, bool answers = true) : console_(console), answers_(answers) {}
  void report(const JobEvent& event);

 private:
  void show(const StageStarted& event);
  void show(const StepProgress& event);
  void show(const StepFinished& event);
  void show(const StepFailed& event);
  void show(const JobWarning&) {}  // the console hears warnings itself, also those outside of runs
  void show(const JobWaiting& event);
  void show(const JobFinished& event);

  void tellReused();

  Console& console_;
  bool answers_;
  std::vector<std::pair<std::string, int>> reused_;  // results of stages, in the order of the run
};

// Exit code of a run: 0 done, 10 some frames failed, 75 interrupted and resumable, else of the failure.
int exitCode(const JobFinished& finished);

}  // namespace beam
