// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/project_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/base/count_text.h"
#include "core/base/word_list.h"
#include "core/pipeline/pending_reason.h"
#include "core/scene/frame_list.h"

namespace beam {
namespace {

using Json = nlohmann::ordered_json;

Json toJsonValue(const FieldValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

std::vector<FrameIndex> framesOf(const Project& project, const StepInfo& step) {
  const std::size_t count = step.per_frame ? project.capture().frames.size() : 1;
  std::vector<FrameIndex> frames;
  for (std::size_t i = 0; i < count; ++i) frames.push_back(FrameIndex{static_cast<std::int32_t>(i)});
  return frames;
}

std::string frameName(const Project& project, FrameIndex frame) {
  return project.capture().frames[static_cast<std::size_t>(frame.value)];
}

// Why a step is not for some frames of their takes; see applies().
const char* whyNotNeeded(const Project& project, const StepInfo& step) {
  switch (step.frames) {
    case Frames::FirstOfTake:
      return "built on the frame before";
    case Frames::InTakes:
      if (project.takes().empty()) return "in no take yet, a run makes takes";
      return "solved alone, in no take";
    case Frames::Every:
      break;
  }
  return "not for them";
}

// "done 000002, 000006; pending 8 more": the finished and failed by name, what is only pending as a count.
std::string stepText(const Project& project, const StepId& id, const StepInfo& step) {
  if (!step.per_frame) return toText(project.state(id, FrameIndex{}));
  std::map<StepState, std::vector<std::string>> by_state;
  for (const FrameIndex frame : framesOf(project, step)) {
    by_state[project.state(id, frame)].push_back(frameName(project, frame));
  }
  std::string text;
  for (const auto& [state, names] : by_state) {
    const bool all = by_state.size() == 1, not_needed = state == StepState::NotNeeded;
    const bool counted = all || state == StepState::Pending || not_needed || names.size() > 12;
    std::string which =
        counted ? countText(names.size(), "frame") : fmt::format("{}", fmt::join(names, ", "));
    if (all) which = names.size() == 1 ? "the frame" : "all frames";
    if (not_needed) which += fmt::format(": {}", whyNotNeeded(project, step));
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", toText(state),
                        counted ? fmt::format("({})", which) : which);
  }
  return text;
}

std::string takesText(const Project& project) {
  std::string text;
  for (const Take& take : project.takes()) {
    text += fmt::format(
        "{} {} to {}{}{}", text.empty() ? "takes" : ",", frameName(project, take.begin()),
        frameName(project, take.last),
        take.step == 1 ? std::string() : fmt::format(" in steps of {}", take.step),
        take.lead == 0 ? std::string() : fmt::format(" (solved from {} on)", frameName(project, take.first)));
  }
  return text.empty() ? text : text + "\n";
}

Json takesJson(const Project& project) {
  Json takes = Json::array();
  for (const Take& take : project.takes()) {
    takes.push_back({{"first", frameName(project, take.begin())},
                     {"last", frameName(project, take.last)},
                     {"step", take.step},
                     {"solved_from", frameName(project, take.first)}});
  }
  return takes;
}

std::string failuresText(const Project& project, const StepId& id, const StepInfo& step) {
  std::string text;
  for (const FrameIndex frame : framesOf(project, step)) {
    if (project.state(id, frame) != StepState::Failed) continue;
    text += fmt::format("    frame {}: {}\n", frameName(project, frame), project.failureOf(id, frame));
  }
  return text;
}

// Asked for where something is pending alone: it reads every record.
class Reasons {
 public:
  explicit Reasons(const Project& project) : project_(project) {}
  std::vector<std::string> of(const StepId& step, FrameIndex frame) {
    if (!reasons_) reasons_.emplace(project_);
    return reasons_->of(step, frame);
  }

 private:
  const Project& project_;
  std::optional<PendingReasons> reasons_;
};

// A line for each cause, with the frames it is about where not all that are pending have it.
std::string reasonsText(const Project& project, const StepId& id, const StepInfo& step, Reasons& reasons) {
  struct Frames {
    std::vector<std::string> names;
    std::vector<int> positions;
  };
  std::map<std::vector<std::string>, Frames> frames_by_reasons;
  for (const FrameIndex frame : framesOf(project, step)) {
    if (project.state(id, frame) != StepState::Pending) continue;
    Frames& frames = frames_by_reasons[reasons.of(id, frame)];
    frames.names.push_back(frameName(project, frame));
    frames.positions.push_back(frame.value);
  }
  std::string text;
  for (const auto& [why, frames] : frames_by_reasons) {
    if (why.empty()) continue;
    const bool some = frames_by_reasons.size() > 1;
    const std::string of = fmt::format(" ({} {})", nounText(frames.names.size(), "frame"),
                                       shortList(frameRanges(frames.names, frames.positions)));
    text += fmt::format("    because {}{}\n", fmt::join(why, ", "), some ? of : std::string());
  }
  return text;
}

Json stepJson(const Project& project, const StepId& id, const StepInfo& step, Reasons& reasons) {
  Json j = {{"id", id.text()}, {"title", step.title}};
  if (!step.per_frame) {
    const StepState state = project.state(id, FrameIndex{});
    j["state"] = toText(state);
    if (state == StepState::Pending) j["reasons"] = reasons.of(id, FrameIndex{});
    j["key"] = project.key(id, FrameIndex{}).hex();
    return j;
  }
  j["frames"] = Json::object();
  for (const FrameIndex frame : framesOf(project, step)) {
    const StepState state = project.state(id, frame);
    Json f = {{"state", toText(state)}};
    if (state != StepState::NotNeeded) f["key"] = project.key(id, frame).hex();
    if (state == StepState::Pending) f["reasons"] = reasons.of(id, frame);
    if (state == StepState::Failed) f["message"] = project.failureOf(id, frame);
    if (state == StepState::Done) {
      if (const auto record = project.record(id, frame)) f["seconds"] = record->seconds;
    }
    j["frames"][frameName(project, frame)] = std::move(f);
  }
  return j;
}

std::string diskText(const StageUse& stage) {
  const std::string others = sizeText(stage.others.bytes);
  if (stage.stage.empty()) return fmt::format("{} (beam clean)", others);
  std::string text = sizeText(stage.in_force.bytes);
  if (stage.others.count > 0) text += fmt::format(", {} not in force (beam clean)", others);
  if (!stage.blocked_reason.empty()) text += " of any settings, as it is blocked";
  return text;
}

Json toJsonValue(const DiskAmount& amount) { return {{"results", amount.count}, {"bytes", amount.bytes}}; }

}  // namespace

const char* toText(StepState state) {
  switch (state) {
    case StepState::Pending:
      return "pending";
    case StepState::Running:
      return "running";
    case StepState::Failed:
      return "failed";
    case StepState::Done:
      return "done";
    case StepState::Blocked:
      return "blocked";
    case StepState::NotNeeded:
      return "not needed";
  }
  return "";
}

std::string statusText(const Project& project) {
  std::string text =
      fmt::format("project {}{}\ncapture {} ({}, {})\npreset {}\n", project.name(),
                  project.readOnly() ? " (read-only)" : "", project.captureFolder().string(),
                  countText(project.capture().views.size(), "camera"),
                  countText(project.capture().frames.size(), "frame"), project.document().preset);
  for (const auto& [key, value] : project.document().settings)
    text += fmt::format("  {} = {}\n", key, toText(value));
  text += takesText(project);
  Reasons reasons(project);
  for (const StageInfo& info : project.setup().stages.infos()) {
    text += fmt::format("{}\n", info.title);
    if (const std::string why = project.blockedReason(info.id); !why.empty()) {
      text += fmt::format("  blocked: {}\n", why);
      continue;
    }
    for (const StepInfo& step : info.steps) {
      const StepId id(info.id, step.id);
      text += fmt::format("  {:<18} {}\n", id.text(), stepText(project, id, step)) +
              failuresText(project, id, step) + reasonsText(project, id, step, reasons);
    }
  }
  text.pop_back();
  return text;
}

std::string statusJson(const Project& project) {
  Json j = {{"project", project.name()},
            {"folder", project.folder().string()},
            {"read_only", project.readOnly()},
            {"capture", project.captureFolder().string()},
            {"preset", project.document().preset}};
  j["settings"] = Json::object();
  for (const auto& [key, value] : project.document().settings) j["settings"][key] = toJsonValue(value);
  j["frames"] = project.capture().frames;
  j["takes"] = takesJson(project);
  j["stages"] = Json::array();
  Reasons reasons(project);
  for (const StageInfo& info : project.setup().stages.infos()) {
    Json stage = {{"id", info.id}, {"title", info.title}};
    const std::string why = project.blockedReason(info.id);
    if (!why.empty()) stage["blocked"] = why;
    stage["steps"] = Json::array();
    for (const StepInfo& step : info.steps) {
      const StepId id(info.id, step.id);
      // What it would read is away: it has no key.
      stage["steps"].push_back(why.empty() ? stepJson(project, id, step, reasons)
                                           : Json{{"id", id.text()}, {"title", step.title}});
    }
    j["stages"].push_back(std::move(stage));
  }
  return j.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string diskText(const DiskUse& use) {
  std::string text;
  for (const StageUse& stage : use.stages) {
    if (stage.in_force.count + stage.others.count == 0) continue;
    text += fmt::format("\n  {:<18} {}", stage.stage.empty() ? stage.title : stage.stage, diskText(stage));
  }
  if (use.checkpoints > 0)
    text += fmt::format("\n  {:<18} {} to go on from where a run was cut off", "checkpoints",
                        sizeText(use.checkpoints));
  return text.empty() ? text : fmt::format("Disk{}", text);
}

std::string diskJson(const DiskUse& use) {
  Json j = {{"in_force", toJsonValue(use.inForce())},
            {"other", toJsonValue(use.others())},
            {"checkpoints_bytes", use.checkpoints}};
  j["stages"] = Json::array();
  for (const StageUse& stage : use.stages) {
    j["stages"].push_back({{"id", stage.stage},
                           {"title", stage.title},
                           {"in_force", toJsonValue(stage.in_force)},
                           {"other", toJsonValue(stage.others)}});
  }
  return j.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace beam
