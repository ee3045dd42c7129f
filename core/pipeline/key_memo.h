// SPDX-License-Identifier: Apache-2.0
// What a project remembers of keys it has worked out. Copies begin without: a memo has one thread.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/hash.h"
#include "core/pipeline/step_id.h"
#include "core/pipeline/takes.h"

namespace beam {

class KeyMemo {
 public:
  KeyMemo() = default;
  KeyMemo(const KeyMemo& /*other*/) {}
  KeyMemo& operator=(const KeyMemo& /*other*/) {
    clear();
    return *this;
  }
  ~KeyMemo() = default;

  void clear() {
    keys.clear();
    parameters.clear();
    works.clear();
    chains.clear();
    owners.clear();
    calibration.reset();
  }

  // A frame seen as a member of one take; another take may own it.
  using Place = std::tuple<StepId, int, int, int, int>;
  static Place placeOf(const StepId& step, const Take& take, FrameIndex frame) {
    return {step, take.first.value, take.last.value, take.step, frame.value};
  }

  std::map<Place, Digest> keys;
  std::map<std::pair<StepId, bool>, std::map<std::string, std::string>> parameters;  // of step, later
  std::map<std::pair<StepId, bool>, double> works;                                   // likewise
  std::map<StepId, std::vector<StepId>> chains;  // what of the frames before enters a step
  std::vector<Take> owners;                      // by frame
  std::optional<Digest> calibration;
};

}  // namespace beam
