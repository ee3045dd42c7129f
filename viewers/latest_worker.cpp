// SPDX-License-Identifier: Apache-2.0
#include "viewers/latest_worker.h"

#include <utility>

namespace beam {

LatestWorker::LatestWorker() : thread_([this](const std::stop_token& stop) { work(stop); }) {}

LatestWorker::~LatestWorker() {
  thread_.request_stop();
  thread_.join();
}

void LatestWorker::submit(std::function<void()> job) {
  {
    std::lock_guard lock(mutex_);
    waiting_ = std::move(job);
  }
  changed_.notify_all();
}

void LatestWorker::waitUntilIdle() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !waiting_ && !running_; });
}

void LatestWorker::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return static_cast<bool>(waiting_); })) {
    if (stop.stop_requested()) return;
    const std::function<void()> job = std::exchange(waiting_, nullptr);
    running_ = true;
    lock.unlock();
    job();
    lock.lock();
    running_ = false;
    changed_.notify_all();
  }
}

}  // namespace beam
