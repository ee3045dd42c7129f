// SPDX-License-Identifier: Apache-2.0
// EventQueue<T>: first in, first out between threads; the only door by which a job's thread speaks to others.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace beam {

template <class T>
class EventQueue {
 public:
  void push(T event) {
    {
      std::lock_guard lock(mutex_);
      events_.push_back(std::move(event));
    }
    arrived_.notify_one();
  }
  // Behind all that was pushed, in a place that is kept for it: takes no memory, so that an end is heard of
  // when there is none. One of an earlier time that nobody took is gone.
  void pushLast(T event) noexcept {
    {
      std::lock_guard lock(mutex_);
      last_.emplace(std::move(event));
    }
    arrived_.notify_one();
  }
  std::optional<T> tryPop() {
    std::lock_guard lock(mutex_);
    return take();
  }
  // Empty after `patience` without an event.
  std::optional<T> waitPop(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, patience, [&] { return !events_.empty() || last_; });
    return take();
  }

 private:
  std::optional<T> take() {
    if (events_.empty()) return std::exchange(last_, std::nullopt);
    T event = std::move(events_.front());
    events_.pop_front();
    return event;
  }

  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<T> events_;
  std::optional<T> last_;
};

}  // namespace beam
