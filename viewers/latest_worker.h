// SPDX-License-Identifier: Apache-2.0
// LatestWorker: one background thread that does the newest job and forgets those it never began. For pictures
// that are out of date before they are drawn: a view submits as often as it likes and stays responsive.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace beam {

class LatestWorker {
 public:
  LatestWorker();
  ~LatestWorker();  // drops the waiting job and waits for the running one
  LatestWorker(const LatestWorker&) = delete;
  LatestWorker& operator=(const LatestWorker&) = delete;

  // `job` must not throw.
  void submit(std::function<void()> job);
  // Until nothing waits or runs.
  void waitUntilIdle();

 private:
  void work(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::function<void()> waiting_;
  bool running_ = false;
  std::jthread thread_;
};

}  // namespace beam
