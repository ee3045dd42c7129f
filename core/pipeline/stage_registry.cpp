// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/stage_registry.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace beam {

std::string stageOf(std::string_view step) { return std::string(step.substr(0, step.find('.'))); }

std::string stepOf(std::string_view step) {
  const std::size_t dot = step.find('.');
  return dot == std::string_view::npos ? std::string() : std::string(step.substr(dot + 1));
}

void StageRegistry::add(Maker maker) {
  const StageInfo info = maker()->info();
  std::set<std::string> known;
  for (const StageInfo& earlier : infos_) {
    if (earlier.id == info.id)
      throw Error(Error::Kind::Bug, fmt::format("stage {} is registered twice", info.id));
    for (const StepInfo& step : earlier.steps) known.insert(earlier.id + "." + step.id);
  }
  for (const StepInfo& step : info.steps) {
    for (const auto* inputs : {&step.inputs, &step.later.inputs}) {
      for (const std::string& input : *inputs) {
        if (known.count(input)) continue;
        throw Error(Error::Kind::Bug, fmt::format("step {}.{} reads {}, which does not stand before it",
                                                  info.id, step.id, input));
      }
    }
    known.insert(info.id + "." + step.id);
  }
  infos_.push_back(info);
  makers_.push_back(std::move(maker));
}

std::size_t StageRegistry::indexOf(std::string_view stage) const {
  std::vector<std::string> known;
  for (const StageInfo& info : infos_) known.push_back(info.id);
  const auto found = std::find(known.begin(), known.end(), stage);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  throw Error(Error::Kind::Usage, fmt::format("there is no stage \"{}\"; the nearest is \"{}\" (stages: {})",
                                              stage, nearestName(stage, known), fmt::join(known, ", ")));
}

std::unique_ptr<Stage> StageRegistry::make(std::string_view stage) const { return makers_[indexOf(stage)](); }

const StageInfo& StageRegistry::info(std::string_view stage) const { return infos_[indexOf(stage)]; }

const StepInfo& StageRegistry::step(std::string_view step) const {
  for (const StepInfo& s : info(stageOf(step)).steps) {
    if (s.id == stepOf(step)) return s;
  }
  throw Error(Error::Kind::Usage, fmt::format("stage {} has no step \"{}\"", stageOf(step), stepOf(step)));
}

void StageRegistry::addWithReads(const std::string& step, std::set<std::string>& all) const {
  if (!all.insert(step).second) return;
  for (const std::string& read : readsOf(this->step(step))) addWithReads(read, all);
}

std::set<std::string> StageRegistry::readBefore(const std::set<std::string>& steps) const {
  std::set<std::string> before;
  for (const std::string& id : steps) {
    for (const std::string& previous : step(id).later.previous) addWithReads(previous, before);
  }
  return before;
}

StepShown shownOf(const StageRegistry& stages, std::string_view step) {
  for (const StageInfo& stage : stages.infos()) {
    for (const StepInfo& info : stage.steps) {
      if (stage.id + "." + info.id == step) return info.shown;
    }
  }
  return {};
}

}  // namespace beam
