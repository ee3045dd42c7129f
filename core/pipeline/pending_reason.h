// SPDX-License-Identifier: Apache-2.0
// Why a result is not there any more: what tells the newest one that there was of the step and frame from the
// one that is in force now, in words for people.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/pipeline/project.h"

namespace beam {

// What of the frame's photographs and masks enters the step: path in the capture, or camera of a source
// without files -> digest, or "unreadable". Empty for a step that reads none.
std::map<std::string, std::string> picturesRead(const Project& project, const StepInfo& step,
                                                FrameIndex frame);

// Of a project that does not change meanwhile. One thread.
class PendingReasons {
 public:
  // Reads all records.
  explicit PendingReasons(const Project& project);

  // Each "surface.iterations 900 → 500", "cam00/000000.png changed"; empty: it was never computed, or there
  // is nothing that differs. Causes that lie in what the step builds on are those of that.
  std::vector<std::string> of(const StepId& step, FrameIndex frame) const;

 private:
  using Reasons = std::vector<std::string>;
  const Reasons& between(const Digest& was, const StepId& step, const Take& take, FrameIndex frame) const;
  Reasons differences(const ResultRecord& was, const StepId& step, const Take& take, FrameIndex frame) const;
  void addParameters(const KeyIngredients& was, const KeyIngredients& now, Reasons& reasons) const;
  void addInputs(const ResultRecord& was, const KeyIngredients& now, FrameIndex frame,
                 Reasons& reasons) const;
  void addResults(const std::map<StepId, Digest>& was, const std::map<StepId, Digest>& now, const Take& take,
                  FrameIndex frame, Reasons& reasons) const;

  const Project& project_;
  std::map<Digest, ResultRecord> records_;
  std::map<std::pair<StepId, std::string>, Digest> newest_;  // by step and frame
  mutable std::map<std::pair<Digest, Digest>, Reasons> known_;
};

}  // namespace beam
