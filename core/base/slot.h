// SPDX-License-Identifier: Apache-2.0
// Slot<T>: the newest value; one writer, any readers. For previews that cross from the job to the window.
#pragma once

#include <memory>
#include <mutex>

namespace beam {

template <class T>
class Slot {
 public:
  void publish(std::shared_ptr<const T> value) {
    std::lock_guard lock(mutex_);
    value_ = std::move(value);
  }
  std::shared_ptr<const T> latest() const {
    std::lock_guard lock(mutex_);
    return value_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const T> value_;
};

}  // namespace beam
