// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/runner.h"

#include "core/base/error.h"
#include "core/pipeline/job.h"
#include "core/render/device.h"

namespace beam {

Runner::~Runner() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Runner::start(Project project, RunRequest request, std::shared_ptr<ComputeDevice> device) {
  if (running_) throw Error(Error::Kind::Bug, "a run was started while another one is going on");
  if (thread_.joinable()) thread_.join();
  running_ = true;
  preview_.publish(nullptr);
  wishes_.clear();
  thread_ = std::jthread([this, project = std::move(project), request = std::move(request),
                          device = std::move(device)](std::stop_token stop) mutable {
    JobFinished finished;
    try {
      Job job(
          project, *device, std::move(stop), wishes_,
          [this](JobEvent event) { events_.push(std::move(event)); }, preview_);
      finished = job.run(request);
    } catch (const std::exception&) {  // not even the words for an error had room
      finished.outcome = JobOutcome::Failed;
      finished.kind = Error::Kind::OutOfMemory;
      finished.message = "out of memory";  // short enough to need none
    }
    running_ = false;
    events_.pushLast(std::move(finished));
  });
}

void Runner::requestStop() { thread_.request_stop(); }

void Runner::requestStopAfter(StopAfter what) { wishes_.add(what); }

}  // namespace beam
