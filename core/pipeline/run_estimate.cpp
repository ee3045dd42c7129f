// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/run_estimate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/base/count_text.h"
#include "core/base/duration_text.h"

namespace beam {
namespace {

// A frame that leads into a take has results of its own and of that take.
void addOnce(const std::string& name, std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

class Estimator {
 public:
  Estimator(const Project& project, const RunPlan& plan, const StepTimes& times)
      : project_(project), times_(times) {
    out_.measured = !times.empty();
    out_.notes = plan.notes;
    for (const auto* steps : {&plan.project_steps, &plan.frame_steps})
      for (const StepId& id : *steps) add(id);
    for (const StepId& id : plan.lead_steps) add(id);
  }

  // `owned`: nobody asked for a lead.
  void step(const StepId& id, const Take& take, FrameIndex frame, bool owned) {
    const StepInfo& info = project_.setup().stages.step(id);
    if (info.per_frame && !applies(info, take, frame)) return;
    StepEstimate& step = out_.steps[places_.at(id)];
    ++out_.steps_total, ++step.total;
    const KeyIngredients ingredients = project_.ingredients(id, take, frame);
    if (project_.store().has(keyOf(ingredients))) return;
    ++out_.steps_missing, ++step.missing;
    if (info.per_frame)
      addOnce(project_.capture().frames[static_cast<std::size_t>(frame.value)], step.frames);
    if (info.per_frame && owned) to_do_.insert(frame.value);
    const auto seconds = times_.guess(kindOf(ingredients), sizeOf(project_, id, ingredients.later));
    if (!seconds) {
      out_.measured = step.measured = false;
      return;
    }
    out_.seconds_low += seconds->low, step.seconds_low += seconds->low;
    out_.seconds_high += seconds->high, step.seconds_high += seconds->high;
  }

  RunEstimate finish(const RunPlan& plan) {
    const auto owned = [](const Turn& turn) { return !turn.lead(); };
    out_.frames_total = static_cast<int>(std::count_if(plan.turns.begin(), plan.turns.end(), owned));
    out_.frames = static_cast<int>(to_do_.size());
    return out_;
  }

 private:
  void add(const StepId& id) {
    if (!places_.emplace(id, out_.steps.size()).second) return;
    StepEstimate step;
    step.step = id;
    step.per_frame = project_.setup().stages.step(id).per_frame;
    out_.steps.push_back(std::move(step));
  }

  const Project& project_;
  const StepTimes& times_;
  RunEstimate out_;
  std::set<std::int32_t> to_do_;
  std::map<StepId, std::size_t> places_;  // in out_.steps
};

std::string aboutText(double low, double high) {
  const std::string from = durationText(low), to = durationText(high);
  return from == to ? fmt::format("about {}", to) : fmt::format("{} to {}", from, to);
}

std::string timeText(const StepEstimate& step) {
  if (step.missing == 0) return "";
  return step.measured ? aboutText(step.seconds_low, step.seconds_high) : "not known yet";
}

// "000002, 000006" of few; "000000 to 000007" of more.
std::string framesText(const StepEstimate& step) {
  if (step.frames.size() <= 3) return fmt::format("{}", fmt::join(step.frames, ", "));
  return fmt::format("{} to {}", step.frames.front(), step.frames.back());
}

std::string totalText(const RunEstimate& e) {
  if (e.steps_missing == 0)
    return fmt::format("nothing to compute: {}{} there", e.steps_total == 1 ? "" : "all ",
                       countText(e.steps_total, "result is", "results are"));
  std::string text =
      fmt::format("{} of {} to compute, for {} of {}", e.steps_missing, countText(e.steps_total, "result"),
                  e.frames, countText(e.frames_total, "frame"));
  return text +
         (e.measured
              ? fmt::format(": {}, as measured on this machine", aboutText(e.seconds_low, e.seconds_high))
              : std::string(
                    "; the time is not known yet: each step is measured when it first runs on this machine"));
}

constexpr const char* kLeavesTake =
    "a frame of a take is solved alone here, not from the frame before it: to keep it in its take, name the "
    "take's first frames too";

// A copy of the project with the takes that the run would make, and the plan of that run.
struct Arranged {
  Arranged(const Project& now, const RunRequest& request) : project(now.sketch()) {
    makeRunPlan(project, request);  // refuses before takes change
    arrangeTakes(project, request);
    plan = makeRunPlan(project, request);
  }

  Project project;
  RunPlan plan;
};

bool leavesTake(const Project& project, const Arranged& arranged) {
  return std::any_of(arranged.plan.turns.begin(), arranged.plan.turns.end(), [&](const Turn& turn) {
    return project.takeOf(turn.frame).before(turn.frame) &&
           !arranged.project.takeOf(turn.frame).before(turn.frame);
  });
}

// What of the table may puzzle.
std::vector<std::string> remarksOf(const RunEstimate& e) {
  std::vector<std::string> remarks;
  const bool led = std::any_of(e.steps.begin(), e.steps.end(), [&](const StepEstimate& step) {
    return step.per_frame && step.total > e.frames_total;
  });
  if (led)
    remarks.emplace_back(
        "more results than frames: a take begins with frames of the take before, which it solves for itself");
  if (e.leaves_take) remarks.emplace_back(kLeavesTake);
  return remarks;
}

}  // namespace

RunEstimate estimateRun(const Project& project, const RunRequest& request, const StepTimes& times) {
  const Arranged arranged(project, request);
  const auto& [sketch, plan] = arranged;
  Estimator estimator(sketch, plan, times);
  for (const StepId& step : plan.project_steps) estimator.step(step, {}, {}, false);
  for (const Turn& turn : plan.turns) {
    const Take take = sketch.takeOf(turn.of);
    for (const StepId& step : turn.lead() ? plan.lead_steps : plan.frame_steps)
      estimator.step(step, take, turn.frame, !turn.lead());
  }
  RunEstimate out = estimator.finish(plan);
  out.leaves_take = leavesTake(project, arranged);
  return out;
}

std::string remarkOfRun(const Project& project, const RunRequest& request) {
  return leavesTake(project, Arranged(project, request)) ? kLeavesTake : "";
}

std::string toText(const RunEstimate& estimate) {
  std::size_t widest = 4;
  for (const StepEstimate& step : estimate.steps) widest = std::max(widest, step.step.text().size());
  std::string text = fmt::format("{:<{}}    to do  of all  {:<20}  frames to do\n", "step", widest, "time");
  for (const StepEstimate& step : estimate.steps) {
    if (step.total == 0) continue;
    std::string line = fmt::format("{:<{}}  {:>7}  {:>6}  {:<20}  {}", step.step.text(), widest, step.missing,
                                   step.total, timeText(step), framesText(step));
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  for (const std::string& note : estimate.notes) text += fmt::format("note: {}\n", note);
  for (const std::string& remark : remarksOf(estimate)) text += fmt::format("note: {}\n", remark);
  return text + totalText(estimate);
}

std::string toJson(const RunEstimate& estimate) {
  using Json = nlohmann::ordered_json;
  const auto seconds = [](bool measured, double low, double high) {
    return measured ? Json{{"low", low}, {"high", high}} : Json();
  };
  Json j = {{"results_missing", estimate.steps_missing},
            {"results", estimate.steps_total},
            {"frames_missing", estimate.frames},
            {"frames", estimate.frames_total},
            {"seconds", seconds(estimate.measured, estimate.seconds_low, estimate.seconds_high)},
            {"leaves_take", estimate.leaves_take},
            {"notes", estimate.notes},
            {"steps", Json::array()}};
  for (const StepEstimate& step : estimate.steps) {
    j["steps"].push_back({{"id", step.step.text()},
                          {"per_frame", step.per_frame},
                          {"missing", step.missing},
                          {"results", step.total},
                          {"frames", step.frames},
                          {"seconds", seconds(step.measured, step.seconds_low, step.seconds_high)}});
  }
  return j.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace beam
