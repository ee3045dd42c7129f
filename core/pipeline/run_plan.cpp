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

void addStage(const StageRegistry& stages, const StageInfo& info, std::set<std::string>& chosen) {
  for (const StepInfo& step : info.steps) stages.addWithReads(info.id + "." + step.id, chosen);
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

// A take whole before the next, in the order of their first frames.
void sortByTakes(const Project& project, std::vector<FrameIndex>& frames) {
  std::map<std::tuple<int, int, int>, FrameIndex> begins;
  const auto beginOf = [&](FrameIndex frame) {
    const Take take = project.takeOf(frame);
    return begins.try_emplace({take.first.value, take.last.value, take.step}, frame).first->second;
  };
  std::vector<std::pair<FrameIndex, FrameIndex>> order;
  order.reserve(frames.size());
  for (const FrameIndex frame : frames) order.emplace_back(beginOf(frame), frame);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i] = order[i].second;
}

constexpr const char* kSegmentSetting = "track.segment_frames";
constexpr int kSegmentFrames = 50;  // of a pipeline that has no such setting

int segmentFrames(const Project& project) {
  for (const Field& field : project.fields()) {
    if (field.info.name != kSegmentSetting) continue;
    if (const int* value = std::get_if<int>(&field.value)) return *value;
  }
  return kSegmentFrames;
}

}  // namespace

void arrangeTakes(Project& project, const RunRequest& request) {
  if (namesTakes(request)) {
    const std::vector<Take> wanted = takesOfFrames(framesOf(project, request), request.every);
    project.changeTakes([&](std::vector<Take> takes) {
      for (const Take& take : wanted) takes = addTake(std::move(takes), take);
      return takes;
    });
    return;
  }
  const int frames = static_cast<int>(project.capture().frames.size());
  const int segment = request.segment_frames ? *request.segment_frames : segmentFrames(project);
  project.changeTakes([&](std::vector<Take> takes) { return joinTakes(std::move(takes), frames, segment); });
}

RunPlan makeRunPlan(const Project& project, const RunRequest& request) {
  const StageRegistry& stages = project.setup().stages;
  if (request.every < 1)
    throw Error(Error::Kind::Usage,
                fmt::format("every: expected a number of frames, 1 or more, found {}", request.every));
  RunPlan plan;
  std::set<std::string> chosen;
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
      const std::string id = info.id + "." + step.id;
      if (chosen.count(id)) (step.per_frame ? plan.frame_steps : plan.project_steps).push_back(id);
    }
  }
  for (const Take& take : takesOfFrames(framesOf(project, request), request.every)) {
    for (const FrameIndex frame : take.frames()) plan.frames.push_back(frame);
  }
  sortByTakes(project, plan.frames);
  return plan;
}

}  // namespace beam
