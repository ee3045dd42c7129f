// SPDX-License-Identifier: Apache-2.0
// What a run is asked to finish before it stops; set by any thread, read by the job's.
#pragma once

#include <atomic>

namespace beam {

enum class StopAfter { Step, Frame };

struct StopWishes {
  std::atomic<bool> after_step{false}, after_frame{false};

  void clear() { after_step = after_frame = false; }
  void add(StopAfter what) { (what == StopAfter::Step ? after_step : after_frame) = true; }
  bool any() const { return after_step || after_frame; }
};

}  // namespace beam
