// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/run_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/error.h"

namespace beam {
namespace {

void addStage(const StageRegistry& stages, const StageInfo& info, std::set<StepId>& chosen) {
  for (const StepInfo& step : info.steps) stages.addWithReads(StepId(info.id, step.id), chosen);
}

std::vector<FrameIndex> framesOf(const Project& project, const RunRequest& request) {
  std::vector<FrameIndex> frames = request.frames;
  std::sort(frames.begin(), frames.end());
  if (frames.empty()) {
    for (std::size_t i = 0; i < project.capture().frames.size(); ++i)
      frames.push_back(FrameIndex{static_cast<std::int32_t>(i)});
  }
  return frames;
}

bool namesTakes(const RunRequest& request) { return !request.frames.empty() || request.every > 1; }

// A take whole before the next, in the order of their first frames; before these, what they build on.
std::vector<Turn> turnsOf(const Project& project, const std::vector<FrameIndex>& frames) {
  std::map<std::tuple<int, int, int, int>, std::size_t> places;
  std::vector<std::vector<Turn>> takes;
  for (const FrameIndex frame : frames) {
    const Take take = project.takeOf(frame);
    const auto [place, fresh] =
        places.try_emplace({take.first.value, take.last.value, take.step, take.lead}, takes.size());
    if (fresh) {
      takes.emplace_back();
      for (FrameIndex before = take.first; before < frame; before.value += take.step)
        takes.back().push_back({before, frame});
    }
    takes[place->second].push_back({frame, frame});
  }
  std::vector<Turn> turns;
  for (const std::vector<Turn>& take : takes) turns.insert(turns.end(), take.begin(), take.end());
  return turns;
}

// What the stages say of takes; "" where none does.
std::string takeSetting(const Project& project, std::string TakeSettings::*name) {
  for (const StageInfo& info : project.setup().stages.infos()) {
    if (!(info.takes.*name).empty()) return info.takes.*name;
  }
  return {};
}

// `fallback`: of a pipeline that has no such setting.
int setting(const Project& project, std::string TakeSettings::*of, int fallback) {
  const std::string name = takeSetting(project, of);
  for (const Field& field : project.fields()) {
    if (field.info.name != name) continue;
    if (const int* value = std::get_if<int>(&field.value)) return *value;
  }
  return fallback;
}

bool goesOnInItsTakes(const Project& project, const RunRequest& request) {
  if (!request.keeps_takes || request.every > 1) return false;
  const RunPlan plan = makeRunPlan(project, request);
  return std::all_of(plan.turns.begin(), plan.turns.end(), [&](const Turn& turn) {
    const Take take = project.takeOf(turn.of);
    return take.count() > 1 && !(turn.lead() && project.lacksAny(plan.lead_steps, take, turn.frame));
  });
}

}  // namespace

void arrangeTakes(Project& project, const RunRequest& request) {
  if (goesOnInItsTakes(project, request)) return;
  const int overlap = request.overlap ? *request.overlap : setting(project, &TakeSettings::overlap, 0);
  if (namesTakes(request)) {
    std::vector<Take> wanted = takesOfFrames(framesOf(project, request), request.every);
    for (Take& take : wanted) {
      if (take.count() > 1) take = withLead(take, overlap);
    }
    project.changeTakes([&](std::vector<Take> takes) {
      for (const Take& take : wanted) takes = addTake(std::move(takes), take);
      return takes;
    });
    return;
  }
  const int frames = static_cast<int>(project.capture().frames.size());
  const int segment =
      request.segment_frames ? *request.segment_frames : setting(project, &TakeSettings::segment_frames, 50);
  project.changeTakes(
      [&](std::vector<Take> takes) { return joinTakes(std::move(takes), frames, segment, overlap); });
}

RunPlan makeRunPlan(const Project& project, const RunRequest& request) {
  project.requireCapture();
  project.environmentFile();  // one that was named and is gone ends the run: nothing is left out in silence
  const StageRegistry& stages = project.setup().stages;
  if (request.every < 1)
    throw Error(Error::Kind::Usage,
                fmt::format("every: expected a number of frames, 1 or more, found {}", request.every));
  RunPlan plan;
  std::set<StepId> chosen;
  if (!request.stage.empty()) {
    const StageInfo& info = stages.info(request.stage);
    if (const std::string why = project.blockedReason(info.id); !why.empty())
      throw Error(Error::Kind::Data, why);
    addStage(stages, info, chosen);
  } else {
    if (!request.until.empty()) stages.info(request.until);  // refuses unknown ones
    for (const StageInfo& info : stages.infos()) {
      if (const std::string why = project.blockedReason(info.id); why.empty()) {
        addStage(stages, info, chosen);
      } else {
        plan.notes.push_back(why);
      }
      if (info.id == request.until) break;
    }
  }
  for (const StageInfo& info : stages.infos()) {
    for (const StepInfo& step : info.steps) {
      const StepId id(info.id, step.id);
      if (chosen.count(id)) (step.per_frame ? plan.frame_steps : plan.project_steps).push_back(id);
    }
  }
  const std::set<StepId> before = stages.readBefore(chosen);
  for (const StepId& id : plan.frame_steps) {
    if (before.contains(id)) plan.lead_steps.push_back(id);
  }
  std::vector<FrameIndex> frames;
  const std::vector<FrameIndex> asked = framesOf(project, request);
  for (const Take& take : takesOfFrames(asked, request.every)) {
    for (const FrameIndex frame : take.frames()) frames.push_back(frame);
  }
  if (!frames.empty() && frames.back() < asked.back()) {
    const std::vector<std::string>& names = project.capture().frames;
    plan.notes.push_back(
        fmt::format("every {}: frame {} is the last that is solved, what follows until {} is not",
                    request.every, names[static_cast<std::size_t>(frames.back().value)],
                    names[static_cast<std::size_t>(asked.back().value)]));
  }
  plan.turns = turnsOf(project, frames);
  return plan;
}

}  // namespace beam
