// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/run_plan.h"

#include <set>

#include "core/base/error.h"

namespace beam {
namespace {

void addStage(const StageRegistry& stages, const StageInfo& info, std::set<std::string>& chosen) {
  for (const StepInfo& step : info.steps) stages.addWithReads(info.id + "." + step.id, chosen);
}

}  // namespace

RunPlan makeRunPlan(const Project& project, const RunRequest& request) {
  const StageRegistry& stages = project.setup().stages;
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
  plan.frames = request.frames;
  if (plan.frames.empty()) {
    for (std::size_t i = 0; i < project.capture().frames.size(); ++i) {
      plan.frames.push_back(FrameIndex{static_cast<std::int32_t>(i)});
    }
  }
  return plan;
}

}  // namespace beam
