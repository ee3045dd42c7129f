// SPDX-License-Identifier: Apache-2.0
// beam clean: takes out of a project what none of its settings refers to.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/cli/answer.h"
#include "app/cli/commands.h"
#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/word_list.h"
#include "core/pipeline/clean_results.h"

namespace beam {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCommand = "clean";

struct CleanFlags {
  std::string project;
  bool dry_run = false;
  AnswerFlags answer;
};

std::string tableText(const CleanPlan& plan, bool dry_run) {
  std::string text =
      fmt::format("{:<14} {:>11} {:>9} {:>9} {:>9}", "results", dry_run ? "to remove" : "removed", "size",
                  dry_run ? "to keep" : "kept", "size");
  for (const StageUse& stage : plan.use.stages) {
    if (stage.in_force.count + stage.others.count == 0) continue;
    text += fmt::format("\n{:<14} {:>11} {:>9} {:>9} {:>9}", stage.stage.empty() ? stage.title : stage.stage,
                        stage.others.count, sizeText(stage.others.bytes), stage.in_force.count,
                        sizeText(stage.in_force.bytes));
  }
  return text;
}

// "also 1 damaged result (12 kB), 2 notes of failures"; empty: nothing of the kind.
std::string alsoText(const CleanPlan& plan) {
  std::vector<std::string> parts;
  if (plan.half_built.count > 0) {
    parts.push_back(fmt::format("{} ({})",
                                countText(plan.half_built.count, "unfinished folder", "unfinished folders"),
                                sizeText(plan.half_built.bytes)));
  }
  if (plan.set_aside.count > 0) {
    parts.push_back(fmt::format("{} ({})",
                                countText(plan.set_aside.count, "damaged result", "damaged results"),
                                sizeText(plan.set_aside.bytes)));
  }
  const auto size = [](const auto& list) { return static_cast<std::int64_t>(list.size()); };
  if (!plan.failures.empty())
    parts.push_back(countText(size(plan.failures), "note of a failure", "notes of failures"));
  if (!plan.leases.empty())
    parts.push_back(countText(size(plan.leases), "lease of a killed process", "leases of killed processes"));
  return parts.empty() ? std::string() : fmt::format("\nalso {}", fmt::join(parts, ", "));
}

std::string blockedText(const CleanPlan& plan) {
  std::string text;
  for (const StageUse& stage : plan.use.stages) {
    if (!stage.blocked_reason.empty() && stage.in_force.count > 0)
      text += fmt::format("\nall of {} stays, of any settings: {}", stage.stage, stage.blocked_reason);
  }
  return text;
}

std::string words(const CleanPlan& plan, bool dry_run) {
  return fmt::format("{}{}{}\n{} {}; {} of results in force stay{}", tableText(plan, dry_run), alsoText(plan),
                     blockedText(plan), dry_run ? "would free" : "freed", sizeText(plan.freedBytes()),
                     sizeText(plan.use.inForce().bytes), dry_run ? "; nothing was removed" : "");
}

Json toJsonValue(const DiskAmount& amount) { return {{"count", amount.count}, {"bytes", amount.bytes}}; }

std::string toJson(const CleanPlan& plan, bool dry_run) {
  Json j = {{"dry_run", dry_run},
            {"freed_bytes", plan.freedBytes()},
            {"removed", toJsonValue(plan.use.others())},
            {"kept", toJsonValue(plan.use.inForce())}};
  j["stages"] = Json::array();
  for (const StageUse& stage : plan.use.stages) {
    Json s = {{"id", stage.stage},
              {"title", stage.title},
              {"removed", toJsonValue(stage.others)},
              {"kept", toJsonValue(stage.in_force)}};
    if (!stage.blocked_reason.empty()) s["blocked"] = stage.blocked_reason;
    j["stages"].push_back(std::move(s));
  }
  j["half_built"] = toJsonValue(plan.half_built);
  j["damaged"] = toJsonValue(plan.set_aside);
  j["failures"] = plan.failures.size();
  j["leases"] = plan.leases.size();
  return j.dump(2, ' ', false, Json::error_handler_t::replace);
}

// Pictures and exports are made of these results now.
std::string lastOnesText(const CleanPlan& plan) {
  if (plan.unsolved.empty()) return {};
  std::vector<std::string> parts;
  for (const auto& [stage, frames] : plan.unsolved)
    parts.push_back(fmt::format("{} of {} {}", stage, nounText(frames.size(), "frame"), shortList(frames)));
  return fmt::format(
      "no result with the settings in force stands in for {}: those that would go are what render, export "
      "and "
      "report use now; beam run it first, or take the settings back with --unset",
      fmt::join(parts, ", "));
}

std::string goneText(const CleanPlan& plan) {
  if (plan.gone.empty()) return {};
  return fmt::format(
      "results that would go were made of what the capture does not have now: {}; put it back, for with it "
      "they may be in force",
      shortList(plan.gone));
}

int runClean(const CleanFlags& flags, CommandContext& context) {
  const auto& pipeline = context.services.pipeline;
  requireAnswerTarget(flags.answer, kCommand);
  Progress progress(context.stop, context.console.listener());
  context.interrupted =
      flags.dry_run ? "interrupted; nothing was removed"
                    : "interrupted; results in force are untouched, what is left of the others the next beam "
                      "clean removes";
  const auto refuse = [&](Error::Kind kind, const std::string& why) {
    if (why.empty()) return;
    if (!flags.dry_run && !flags.answer.force)
      throw Error(kind, fmt::format("{}; --force removes them all the same", why));
    context.console.warning(why);
  };
  const auto accept = [&](const CleanPlan& plan) {
    refuse(Error::Kind::Data, goneText(plan));
    refuse(Error::Kind::Usage, lastOnesText(plan));
  };
  const CleanPlan plan = flags.dry_run ? planClean(Project::open(flags.project, pipeline), progress)
                                       : cleanResults(flags.project, pipeline, progress, accept);
  if (flags.dry_run) accept(plan);
  context.console.endProgress();
  answer(
      flags.answer, kCommand, context.console, [&] { return words(plan, flags.dry_run); },
      [&] { return toJson(plan, flags.dry_run); });
  return 0;
}

}  // namespace

void addCleanCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<CleanFlags>();
  CLI::App* command =
      app.add_subcommand("clean", "Remove results that no setting in force refers to, and what kills left");
  command->add_option("PROJECT", flags->project, "Project folder")->required();
  command->add_flag("--dry-run", flags->dry_run, "Say what would be removed, and remove nothing");
  addAnswerFlags(*command, flags->answer);
  command->get_option("--force")->description(
      "Replace files that this command did not write; remove also the last results of a stage and those of "
      "pictures that are gone");
  command->callback(
      [flags, &context] { context.action = [flags, &context] { return runClean(*flags, context); }; });
}

}  // namespace beam
