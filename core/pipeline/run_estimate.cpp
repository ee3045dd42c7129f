// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/run_estimate.h"

#include <algorithm>
#include <set>

namespace beam {
namespace {

class Estimator {
 public:
  Estimator(const Project& project, const StepTimes& times) : project_(project), times_(times) {
    out_.measured = !times.empty();
  }

  // `owned`: nobody asked for a lead.
  void step(const StepId& id, const Take& take, FrameIndex frame, bool owned) {
    const StepInfo& info = project_.setup().stages.step(id);
    if (info.per_frame && !applies(info, take, frame)) return;
    ++out_.steps_total;
    const KeyIngredients ingredients = project_.ingredients(id, take, frame);
    if (project_.store().has(keyOf(ingredients))) return;
    ++out_.steps_missing;
    if (info.per_frame && owned) to_do_.insert(frame.value);
    const auto seconds = times_.guess(kindOf(ingredients), sizeOf(project_, id, ingredients.later));
    if (!seconds) {
      out_.measured = false;
      return;
    }
    out_.seconds_low += seconds->low;
    out_.seconds_high += seconds->high;
  }

  RunEstimate finish(const RunPlan& plan) {
    const auto owned = [](const Turn& turn) { return !turn.lead(); };
    out_.frames_total = static_cast<int>(std::count_if(plan.turns.begin(), plan.turns.end(), owned));
    out_.frames = static_cast<int>(to_do_.size());
    return out_;
  }

 private:
  const Project& project_;
  const StepTimes& times_;
  RunEstimate out_;
  std::set<std::int32_t> to_do_;
};

}  // namespace

RunEstimate estimateRun(const Project& project, const RunRequest& request, const StepTimes& times) {
  Project sketch = project.sketch();
  makeRunPlan(sketch, request);  // refuses before takes change
  arrangeTakes(sketch, request);
  const RunPlan plan = makeRunPlan(sketch, request);
  Estimator estimator(sketch, times);
  for (const StepId& step : plan.project_steps) estimator.step(step, {}, {}, false);
  for (const Turn& turn : plan.turns) {
    const Take take = sketch.takeOf(turn.of);
    for (const StepId& step : turn.lead() ? plan.lead_steps : plan.frame_steps)
      estimator.step(step, take, turn.frame, !turn.lead());
  }
  RunEstimate out = estimator.finish(plan);
  out.leaves_take = std::any_of(plan.turns.begin(), plan.turns.end(), [&](const Turn& turn) {
    return project.takeOf(turn.frame).before(turn.frame) && !sketch.takeOf(turn.frame).before(turn.frame);
  });
  return out;
}

}  // namespace beam
