// SPDX-License-Identifier: Apache-2.0
// Checkpoints on the disk: the two newest of a result that is being computed, in a folder of its own that
// goes when the result is there. Whoever holds the lease of the result's key has it alone.
#pragma once

#include <chrono>
#include <filesystem>

#include "core/base/checkpoint.h"

namespace beam {

class CheckpointFiles final : public Checkpoint {
 public:
  // Due each `every`, more seldom where keeping takes more than a fiftieth of the time.
  explicit CheckpointFiles(std::filesystem::path folder, std::chrono::milliseconds every = kEvery);

  bool due() const override { return Clock::now() >= next_; }
  void keep(const CheckpointWriter& what, const Progress& progress) override;
  std::unique_ptr<CheckpointReader> kept() const override;

 private:
  using Clock = std::chrono::steady_clock;
  void removeHalfWritten() const;
  static constexpr std::chrono::seconds kEvery{60};  // the most work that a kill may cost

  std::filesystem::path folder_;
  std::chrono::milliseconds every_;
  Clock::time_point next_;
  bool warned_ = false;
};

}  // namespace beam
