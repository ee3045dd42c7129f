// SPDX-License-Identifier: Apache-2.0
#include "app/cli/json_reporter.h"

#include <nlohmann/json.hpp>

#include "app/cli/console_reporter.h"

namespace beam {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds kProgressEvery{100};

Json of(const char* event, const StepRef& ref) {
  Json j = {{"event", event}, {"step", ref.step.text()}};
  if (ref.frame) j["frame"] = ref.frame_name;
  if (ref.lead) j["lead"] = true;
  return j;
}

Json toJsonValue(const StageStarted& e) {
  Json j = {{"event", "stage"}, {"stage", e.stage}};
  if (e.frame) j["frame"] = e.frame_name;
  return j;
}

Json toJsonValue(const StepProgress& e) {
  Json j = of("progress", e.ref);
  j["label"] = e.report.label;
  j["fraction"] = e.report.fraction;
  j["done"] = e.report.done;
  j["total"] = e.report.total;
  j["run_fraction"] = e.job_fraction;
  j["seconds_elapsed"] = e.seconds_elapsed;
  j["seconds_left"] = e.seconds_left < 0 ? Json() : Json(e.seconds_left);
  return j;
}

Json toJsonValue(const StepFinished& e) {
  Json j = of("step", e.ref);
  j["key"] = e.key.hex();
  j["reused"] = e.reused;
  j["seconds"] = e.seconds;
  return j;
}

Json toJsonValue(const StepFailed& e) {
  Json j = of("step_failed", e.ref);
  j["message"] = e.message;
  return j;
}

Json toJsonValue(const JobWarning& e) { return {{"event", "warning"}, {"message", e.text}}; }

Json toJsonValue(const JobWaiting& e) {
  Json j = of("waiting", e.ref);
  j["holder"] = e.holder;
  return j;
}

const char* toText(JobOutcome outcome) {
  switch (outcome) {
    case JobOutcome::Done:
      return "done";
    case JobOutcome::DoneWithFailures:
      return "done with failures";
    case JobOutcome::Cancelled:
      return "interrupted";
    case JobOutcome::Failed:
      return "failed";
  }
  return "";
}

Json toJsonValue(const JobFinished& e) {
  Json j = {{"event", "finished"},    {"outcome", toText(e.outcome)}, {"exit_code", exitCode(e)},
            {"computed", e.computed}, {"reused", e.reused},           {"seconds", e.seconds},
            {"notes", e.notes},       {"failed", Json::array()}};
  if (!e.message.empty()) j["message"] = e.message;
  for (const StepFailed& f : e.failed) {
    Json failed = of("step_failed", f.ref);
    failed.erase("event");
    failed["message"] = f.message;
    j["failed"].push_back(std::move(failed));
  }
  return j;
}

}  // namespace

void JsonReporter::report(const JobEvent& event) {
  if (std::holds_alternative<StepProgress>(event)) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_progress_ < kProgressEvery) return;
    last_progress_ = now;
  }
  const Json j = std::visit([](const auto& e) { return toJsonValue(e); }, event);
  console_.print(j.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace beam
