// SPDX-License-Identifier: Apache-2.0
// Runner: one job, one thread, a stream of events. The command line and the studio drive the same class:
// start, read events until JobFinished, look at the preview when drawing.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/slot.h"
#include "core/pipeline/event_queue.h"
#include "core/pipeline/job_event.h"
#include "core/pipeline/project.h"
#include "core/pipeline/run_plan.h"
#include "core/pipeline/stop_wishes.h"
#include "core/scene/gaussian_cloud.h"

namespace beam {

class Runner {
 public:
  Runner() = default;
  ~Runner();  // requests a stop and waits
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  // Works on a snapshot: later changes of `project` do not reach this run, and the takes it makes reach only
  // project.json (Project::readTakesAgain). One run at a time: throws
  // Error{Bug} while one is going on. Whatever goes wrong inside arrives as JobFinished, the last event of a
  // run.
  void start(Project project, RunRequest request, std::shared_ptr<ComputeDevice> device);
  void requestStop();
  // Ends the run once the step, or every step of the frame, at work is published; a run that waits ends at
  // once. The outcome is Cancelled with JobFinished::at_rest. For this run alone; requestStop stays possible.
  void requestStopAfter(StopAfter what);
  // From start until JobFinished was pushed.
  bool running() const { return running_; }

  std::optional<JobEvent> tryPop() { return events_.tryPop(); }
  std::optional<JobEvent> waitPop(std::chrono::milliseconds patience) { return events_.waitPop(patience); }
  // The newest Gaussians of the step at work; empty before the first.
  const Slot<JobPreview>& preview() const { return preview_; }

 private:
  EventQueue<JobEvent> events_;
  Slot<JobPreview> preview_;
  std::atomic<bool> running_{false};
  StopWishes wishes_;
  std::jthread thread_;
};

}  // namespace beam
