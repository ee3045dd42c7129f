// SPDX-License-Identifier: Apache-2.0
// How a long computation shows what it has so far. May be empty; called on the job's thread, about once a
// second.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "core/scene/gaussian_cloud.h"

namespace beam {

using CloudPreview = std::function<void(std::shared_ptr<const GaussianCloud>)>;

// Keeps to once a second in a loop.
class TimedPreview {
 public:
  explicit TimedPreview(const CloudPreview& preview) : preview_(preview) {}

  // `source.cloud()` is asked for only when it is time.
  template <class Source>
  void offer(const Source& source) {
    if (!preview_ || Clock::now() - shown_ <= std::chrono::seconds(1)) return;
    preview_(std::make_shared<const GaussianCloud>(source.cloud()));
    shown_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  const CloudPreview& preview_;
  Clock::time_point shown_ = Clock::now();
};

}  // namespace beam
