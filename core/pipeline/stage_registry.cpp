// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/stage_registry.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/pipeline/result_key.h"

namespace beam {

namespace {

// Fields of groups that belong to no step of the stage, or are of later frames where no step has any.
void requireKeys(Stage& stage) {
  const StageInfo& info = stage.info();
  for (const Field& field : fieldsOf(stage)) {
    const bool enters = std::any_of(info.steps.begin(), info.steps.end(), [&](const StepInfo& step) {
      return entersKey(field.info, step.id, !step.later.empty());
    });
    if (enters || field.info.effect != Effect::Result) continue;
    const std::size_t dot = field.info.name.find('.');
    const bool grouped = dot != std::string::npos;
    const std::string group =
        grouped ? fmt::format(" of the group \"{}\"", field.info.name.substr(0, dot)) : "";
    throw Error(Error::Kind::Bug,
                fmt::format("stage {}: setting \"{}\"{} changes results and enters no key: expected a group "
                            "named after a step, or \"later\" where one has later frames",
                            info.id, grouped ? field.info.name.substr(dot + 1) : field.info.name, group));
  }
}

}  // namespace

void StageRegistry::add(Maker maker) {
  const std::unique_ptr<Stage> stage = maker();
  const StageInfo info = stage->info();
  std::set<StepId> known;
  for (const StageInfo& earlier : groups_) {
    if (earlier.id == info.id)
      throw Error(Error::Kind::Bug, fmt::format("stage {} is registered twice", info.id));
    for (const StepInfo& step : earlier.steps) known.insert(StepId(earlier.id, step.id));
  }
  for (const StepInfo& step : info.steps) {
    for (const auto* inputs : {&step.inputs, &step.later.inputs}) {
      for (const StepId& input : *inputs) {
        if (known.count(input)) continue;
        throw Error(Error::Kind::Bug, fmt::format("step {}.{} reads {}, which does not stand before it",
                                                  info.id, step.id, input.text()));
      }
    }
    known.insert(StepId(info.id, step.id));
  }
  requireKeys(*stage);
  groups_.push_back(info);
  if (!info.steps.empty()) infos_.push_back(info);
  makers_.push_back(std::move(maker));
}

const StageInfo& StageRegistry::info(std::string_view stage) const {
  std::vector<std::string> known;
  for (const StageInfo& info : infos_) {
    if (info.id == stage) return info;
    known.push_back(info.id);
  }
  const auto of_settings = [&](const StageInfo& group) { return group.id == stage; };
  if (std::any_of(groups_.begin(), groups_.end(), of_settings)) {
    throw Error(Error::Kind::Usage,
                fmt::format("stage {} has settings and no steps: there is nothing of it to run", stage));
  }
  throw Error(Error::Kind::Usage, noSuchName("stage", stage, known, "beam stages lists them"));
}

std::unique_ptr<Stage> StageRegistry::make(std::string_view stage) const {
  const auto found =
      std::find_if(groups_.begin(), groups_.end(), [&](const StageInfo& g) { return g.id == stage; });
  if (found == groups_.end()) info(stage);  // refuses it
  return makers_[static_cast<std::size_t>(found - groups_.begin())]();
}

const StepInfo* StageRegistry::find(const StepId& step) const {
  for (const StageInfo& stage : infos_) {
    for (const StepInfo& s : stage.steps)
      if (StepId(stage.id, s.id) == step) return &s;
  }
  return nullptr;
}

const StepInfo& StageRegistry::step(const StepId& step) const {
  if (const StepInfo* found = find(step)) return *found;
  info(step.stage());  // refuses an unknown stage
  throw Error(Error::Kind::Usage, fmt::format("stage {} has no step \"{}\"", step.stage(), step.name()));
}

std::vector<Field> StageRegistry::allFields(
    const std::function<std::unique_ptr<Stage>(std::string_view)>& make) const {
  std::vector<Field> all;
  for (const StageInfo& info : groups_) {
    for (Field& field : fieldsOf(*make(info.id))) {
      field.info.name = info.id + "." + field.info.name;
      all.push_back(std::move(field));
    }
  }
  return all;
}

void StageRegistry::addWithReads(const StepId& step, std::set<StepId>& all) const {
  if (!all.insert(step).second) return;
  for (const StepId& read : readsOf(this->step(step))) addWithReads(read, all);
}

std::set<StepId> StageRegistry::readBefore(const std::set<StepId>& steps) const {
  std::set<StepId> before;
  for (const StepId& id : steps) {
    for (const StepId& previous : step(id).later.previous) addWithReads(previous, before);
  }
  return before;
}

StepShown shownOf(const StageRegistry& stages, const StepId& step) {
  return stages.has(step) ? stages.step(step).shown : StepShown{};
}

}  // namespace beam
