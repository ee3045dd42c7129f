// SPDX-License-Identifier: Apache-2.0
#include "app/cli/console_reporter.h"

#include <fmt/format.h>

#include "app/cli/exit_codes.h"
#include "core/base/count_text.h"
#include "core/base/duration_text.h"

namespace beam {
namespace {

std::string nameOf(const StepRef& ref) {
  if (!ref.frame) return ref.step.text();
  return fmt::format("frame {}{} {}", ref.frame_name, ref.lead ? " (lead)" : "", ref.step.text());
}

std::string namesOf(const std::vector<StepFailed>& failed) {
  std::string names;
  for (const StepFailed& f : failed) names.append(names.empty() ? "" : ", ").append(f.ref.frame_name);
  return names;
}

std::string failuresText(const JobFinished& e) {
  const std::string names = namesOf(e.failed);
  const auto failed = static_cast<int>(e.failed.size());
  if (failed < e.frames)
    return fmt::format("{} of {} failed ({}); the others are done", failed, countText(e.frames, "frame"),
                       names);
  return failed == 1 ? fmt::format("the frame failed ({})", names)
                     : fmt::format("all {} failed ({})", countText(failed, "frame"), names);
}

}  // namespace

void ConsoleReporter::report(const JobEvent& event) {
  std::visit([this](const auto& e) { show(e); }, event);
}

void ConsoleReporter::show(const StageStarted&) {}

void ConsoleReporter::show(const StepProgress& e) {
  std::string label = nameOf(e.ref);
  if (!e.report.label.empty()) label += ": " + e.report.label;
  if (e.report.total > 0) label += fmt::format(" {}/{}", e.report.done, e.report.total);
  console_.progress({e.job_fraction, label, e.rate, e.seconds_left});
}

void ConsoleReporter::show(const StepFinished& e) {
  if (!e.reused) {
    // Among the details the log says it.
    if (!console_.verbose()) console_.info(fmt::format("{}: done in {:.1f} s", nameOf(e.ref), e.seconds));
    return;
  }
  console_.detail(fmt::format("{}: reused", nameOf(e.ref)));
  const std::string_view stage = e.ref.step.stage();
  const auto known =
      std::find_if(reused_.begin(), reused_.end(), [&](const auto& r) { return r.first == stage; });
  known == reused_.end() ? void(reused_.emplace_back(stage, 1)) : void(++known->second);
}

void ConsoleReporter::tellReused() {
  for (const auto& [stage, results] : reused_)
    console_.info(fmt::format("{}: {} reused", stage, countText(results, "result")));
  reused_.clear();
}

void ConsoleReporter::show(const StepFailed& e) {
  const std::string text = fmt::format("{}: {}", nameOf(e.ref), e.message);
  e.ref.lead ? console_.warning(text) : console_.error(text);
}

void ConsoleReporter::show(const JobWaiting& e) {
  console_.info(fmt::format("waits for {}, which {} computes", nameOf(e.ref), e.holder));
}

void ConsoleReporter::show(const JobFinished& e) {
  console_.endProgress();
  tellReused();
  for (const std::string& note : e.notes) answers_ ? console_.tell(note) : console_.info(note);
  switch (e.outcome) {
    case JobOutcome::Done:
      console_.info(e.computed == 0
                        ? fmt::format("nothing to compute: {}{} there already (reused)",
                                      e.reused == 1 ? "" : "all ",
                                      countText(e.reused, "result is", "results are"))
                        : fmt::format("done in {}: {} computed, {} reused", durationText(e.seconds),
                                      countText(e.computed, "step"), e.reused));
      break;
    case JobOutcome::DoneWithFailures:
      console_.error(failuresText(e));
      break;
    case JobOutcome::Cancelled:
      console_.info("interrupted; the same command goes on after the last finished step");
      break;
    case JobOutcome::Failed:
      console_.error(e.message);
      break;
  }
}

int exitCode(const JobFinished& finished) {
  switch (finished.outcome) {
    case JobOutcome::Done:
      return kDone;
    case JobOutcome::DoneWithFailures:
      return kSomeFailed;
    case JobOutcome::Cancelled:
      return kInterrupted;
    case JobOutcome::Failed:
      return exitCode(finished.kind);
  }
  return exitCode(Error::Kind::Bug);
}

}  // namespace beam
