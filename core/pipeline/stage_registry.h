// SPDX-License-Identifier: Apache-2.0
// The stages of this program in pipeline order. A stage object holds its own options, so everyone makes a
// fresh one.
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/pipeline/stage.h"

namespace beam {

class StageRegistry {
 public:
  using Maker = std::function<std::unique_ptr<Stage>()>;
  // Throws Error{Bug} when the id is taken, a step names an input that does not stand before it, or a setting
  // that changes results enters no key (entersKey): changed, it would be answered with old results.
  void add(Maker maker);
  // Those with steps, in order of adding.
  const std::vector<StageInfo>& infos() const { return infos_; }
  // Also those without, which are groups of settings that enter no key.
  const std::vector<StageInfo>& groups() const { return groups_; }
  // Both throw Error{Usage} that names the nearest stage; info() also for one without steps.
  std::unique_ptr<Stage> make(std::string_view stage) const;
  const StageInfo& info(std::string_view stage) const;
  // Throws Error{Usage} likewise.
  const StepInfo& step(const StepId& step) const;
  // A pipeline need not have every step of the house.
  bool has(const StepId& step) const { return find(step) != nullptr; }
  // Every setting as `make` makes the stages, by its whole name: "surface.iterations".
  std::vector<Field> allFields(const std::function<std::unique_ptr<Stage>(std::string_view)>& make) const;
  // Into `all`: the step and everything that enters it, in this frame and those before.
  void addWithReads(const StepId& step, std::set<StepId>& all) const;
  // Steps of earlier frames that `steps` of a later one read, with everything that enters these.
  std::set<StepId> readBefore(const std::set<StepId>& steps) const;

 private:
  const StepInfo* find(const StepId& step) const;

  std::vector<StageInfo> infos_, groups_;
  std::vector<Maker> makers_;  // of groups_
};

// Of a result by its step; nothing of a step that this program does not have.
StepShown shownOf(const StageRegistry& stages, const StepId& step);

}  // namespace beam
