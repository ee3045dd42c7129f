// SPDX-License-Identifier: Apache-2.0
// Task<Outcome>: one long piece of work on a thread of its own, with its progress, a stop, and what came of
// it by value. For work that is no run of the pipeline: a sample being made, a project being scored.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <thread>
#include <utility>

#include "core/base/progress.h"
#include "core/base/slot.h"

namespace beam {

template <class Outcome>
class Task {
 public:
  // On the task's thread; may throw. To be stopped is to throw Cancelled.
  using Work = std::function<Outcome(Progress&)>;

  // Begins at once. `ended` (may be empty, must not throw): called on the task's thread as the last thing it
  // does, when take() waits no longer.
  explicit Task(Work work, std::function<void()> ended = {}) {
    std::packaged_task<Outcome(Progress&)> task(std::move(work));
    outcome_ = task.get_future();
    thread_ = std::jthread([task = std::move(task), ended = std::move(ended),
                            newest = newest_](const std::stop_token& stop) mutable {
      Progress progress(
          stop, [&](const ProgressReport& r) { newest->publish(std::make_shared<const ProgressReport>(r)); });
      task(progress);
      if (ended) ended();
    });
  }
  // Requests a stop and waits.
  ~Task() = default;
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  void requestStop() { thread_.request_stop(); }
  // The newest; null: none yet.
  std::shared_ptr<const ProgressReport> progress() const { return newest_->latest(); }
  bool ended() const {
    return !outcome_.valid() || outcome_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
  // Waits for the end. Once: the outcome, or throws what the work threw.
  Outcome take() { return outcome_.get(); }

 private:
  std::shared_ptr<Slot<ProgressReport>> newest_ = std::make_shared<Slot<ProgressReport>>();
  std::future<Outcome> outcome_;
  std::jthread thread_;  // last: it stops first
};

}  // namespace beam
