// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/settings_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/count_text.h"
#include "core/base/field_text.h"
#include "core/pipeline/presets.h"

namespace beam {
namespace {

using Json = nlohmann::ordered_json;

Json toJsonValue(const FieldValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

// A setting of a project.
struct InForce {
  FieldValue value;
  std::string from;  // "default", "preset standard", "set"
};

struct Setting {
  FieldInfo info;  // under the full name
  FieldValue default_value;
  std::vector<std::pair<std::string, FieldValue>> presets;  // by name, in their order
  std::optional<InForce> in_force;
};

using Values = std::map<std::string, FieldValue>;

// The settings of one stage.
class Settings {
 public:
  Settings(const PipelineSetup& setup, const Project* project) : setup_(setup), project_(project) {
    if (setup.presets.empty()) return;
    for (const std::string& name : presetNamesIn(setup.presets))
      presets_.emplace_back(name, loadPreset(setup.presets, name));
  }

  std::vector<Setting> of(const std::string& stage) const {
    std::vector<Setting> settings;
    const std::vector<Field> defaults = fieldsOf(*setup_.stages.make(stage));
    std::vector<Field> in_force;
    if (project_) in_force = fieldsOf(*project_->makeStage(stage));
    for (std::size_t i = 0; i < defaults.size(); ++i) {
      Setting s{defaults[i].info, defaults[i].value, {}, {}};
      s.info.name = fmt::format("{}.{}", stage, s.info.name);
      for (const auto& [name, values] : presets_) s.presets.emplace_back(name, valueIn(values, s));
      if (project_) s.in_force = InForce{in_force[i].value, originOf(s.info.name)};
      settings.push_back(std::move(s));
    }
    return settings;
  }

 private:
  static FieldValue valueIn(const Values& values, const Setting& setting) {
    const auto found = values.find(setting.info.name);
    return found == values.end() ? setting.default_value : found->second;
  }

  std::string originOf(const std::string& key) const {
    if (project_->document().settings.contains(key)) return "set";
    for (const auto& [name, values] : presets_)
      if (name == project_->document().preset && values.contains(key)) return fmt::format("preset {}", name);
    return "default";
  }

  const PipelineSetup& setup_;
  const Project* project_;
  std::vector<std::pair<std::string, Values>> presets_;
};

Json toJsonValue(const Setting& setting) {
  const FieldInfo& info = setting.info;
  Json j = {{"key", info.name},
            {"label", info.label},
            {"help", info.help},
            {"default", toJsonValue(setting.default_value)}};
  j["presets"] = Json::object();
  for (const auto& [name, value] : setting.presets) j["presets"][name] = toJsonValue(value);
  if (setting.in_force) {
    j["value"] = toJsonValue(setting.in_force->value);
    j["from"] = setting.in_force->from;
  }
  if (std::isfinite(info.min)) j["min"] = info.min;
  if (std::isfinite(info.max)) j["max"] = info.max;
  if (!info.unit.empty()) j["unit"] = info.unit;
  if (!info.choices.empty()) j["choices"] = info.choices;
  if (info.advanced) j["advanced"] = true;
  if (info.effect == Effect::SpeedOnly) j["speed_only"] = true;
  if (info.effect == Effect::Pictures) j["pictures_only"] = true;
  return j;
}

std::string limitsText(const FieldInfo& info) {
  if (!info.choices.empty()) return fmt::format("{}", fmt::join(info.choices, ", "));
  const std::string range = rangeText(info);
  return range.empty() && !info.unit.empty() ? info.unit : range;
}

// "draft 1500, standard 7000": those that say something else than the default.
std::string presetsText(const Setting& setting) {
  std::vector<std::string> told;
  for (const auto& [name, value] : setting.presets)
    if (toText(value) != toText(setting.default_value))
      told.push_back(fmt::format("{} {}", name, toText(value)));
  return fmt::format("{}", fmt::join(told, ", "));
}

// "surface.cap = 400 (set; default 1000; ...)"; of no project, where nothing is in force,
// "surface.cap: default 1000 (...)".
std::string lineOf(const Setting& setting) {
  const std::string initial = fmt::format("default {}", toText(setting.default_value));
  std::string value = fmt::format(": {}", initial);
  std::vector<std::string> told;
  if (setting.in_force) {
    value = fmt::format(" = {}", toText(setting.in_force->value));
    told.push_back(setting.in_force->from);
    if (setting.in_force->from != "default") told.push_back(initial);
  }
  for (const std::string& more : {presetsText(setting), limitsText(setting.info)})
    if (!more.empty()) told.push_back(more);
  const std::string remarks = told.empty() ? "" : fmt::format(" ({})", fmt::join(told, "; "));
  return fmt::format("  {}{}{}\n      {}\n", setting.info.name, value, remarks, setting.info.help);
}

Json idsJson(const std::vector<StepId>& steps) {
  Json ids = Json::array();
  for (const StepId& step : steps) ids.push_back(step.text());
  return ids;
}

Json idsJson(const Later& later) {
  return {{"inputs", idsJson(later.inputs)}, {"previous", idsJson(later.previous)}};
}

const char* toText(Frames frames) {
  switch (frames) {
    case Frames::Every:
      return "every";
    case Frames::FirstOfTake:
      return "first of take";
    case Frames::InTakes:
      return "in takes";
  }
  return "";
}

Json toJsonValue(const StageInfo& info, const StepInfo& step) {
  return {{"id", info.id + "." + step.id},
          {"title", step.title},
          {"source", step.source},
          {"version", step.version},
          {"unmasked_version", step.unmasked_version},
          {"per_frame", step.per_frame},
          {"frames", toText(step.frames)},
          {"inputs", idsJson(step.inputs)},
          {"later", idsJson(step.later)}};
}

}  // namespace

std::string stagesText(const PipelineSetup& setup, const Project* project) {
  const Settings settings(setup, project);
  std::string text;
  if (project) {
    text = fmt::format("project {}, preset {}, {} set beside it\n", project->name(),
                       project->document().preset, countText(project->document().settings.size(), "setting"));
  }
  for (const StageInfo& info : setup.stages.groups()) {
    text += fmt::format("{}: {}. {}\n", info.id, info.title, info.summary);
    for (const StepInfo& step : info.steps) {
      text += fmt::format("  step {}.{}: {}{}\n", info.id, step.id, step.title,
                          step.source.empty() ? "" : " (" + step.source + ")");
    }
    for (const Setting& setting : settings.of(info.id)) text += lineOf(setting);
  }
  if (!text.empty()) text.pop_back();
  return text;
}

std::string stagesJson(const PipelineSetup& setup, const Project* project) {
  const Settings settings(setup, project);
  Json j = Json::object();
  if (project) j = {{"project", project->name()}, {"preset", project->document().preset}};
  j["stages"] = Json::array();
  for (const StageInfo& info : setup.stages.groups()) {
    Json stage = {{"id", info.id}, {"title", info.title}, {"summary", info.summary}};
    stage["steps"] = Json::array();
    for (const StepInfo& step : info.steps) stage["steps"].push_back(toJsonValue(info, step));
    stage["settings"] = Json::array();
    for (const Setting& setting : settings.of(info.id)) stage["settings"].push_back(toJsonValue(setting));
    j["stages"].push_back(std::move(stage));
  }
  return j.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace beam
