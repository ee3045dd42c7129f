// SPDX-License-Identifier: Apache-2.0
// beam evaluate: scores against ground truth, or of the held-out photographs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/cli/commands.h"
#include "core/io/file.h"
#include "core/work/evaluate.h"

namespace beam {
namespace {

struct EvaluateFlags {
  std::string project, truth, pictures, json, frames = "all";
  DeviceChoice device;
};

std::size_t widthOf(std::string_view column) { return std::max<std::size_t>(15, column.size() + 2); }

std::string scoreText(const ScoreTable& table) {
  static const std::vector<std::pair<const char*, const char*>> kColumns = {{"psnr", "{:.3f}"},
                                                                            {"ssim", "{:.4f}"},
                                                                            {"psnr_mask", "{:.3f}"},
                                                                            {"angle_deg", "{:.3f}"},
                                                                            {"mae_mm", "{:.3f}"},
                                                                            {"chamfer_mm", "{:.3f}"},
                                                                            {"pred_to_gt_mm", "{:.3f}"},
                                                                            {"gt_to_pred_mm", "{:.3f}"},
                                                                            {"median_mm", "{:.3f}"},
                                                                            {"p95_mm", "{:.3f}"},
                                                                            {"radiance", "{:.5f}"},
                                                                            {"base_color", "{:.5f}"},
                                                                            {"gaussian_radiance", "{:.5f}"},
                                                                            {"gaussian_base_color", "{:.5f}"},
                                                                            {"pictures", "{:.0f}"}};
  std::vector<std::pair<const char*, const char*>> columns;
  for (const auto& c : kColumns) {
    if (std::any_of(table.begin(), table.end(),
                    [&](const auto& row) { return row.second.contains(c.first); }))
      columns.push_back(c);
  }
  std::string text = fmt::format("{:<28}", "map");
  for (const auto& c : columns) text += fmt::format("{:>{}}", c.first, widthOf(c.first));
  for (const auto& [name, scores] : table) {
    text += fmt::format("\n{:<28}", name);
    for (const auto& [key, format] : columns) {
      const auto found = scores.find(key);
      text += fmt::format("{:>{}}",
                          found == scores.end() ? "-" : fmt::format(fmt::runtime(format), found->second),
                          widthOf(key));
    }
  }
  return text;
}

int runEvaluate(const EvaluateFlags& flags, CommandContext& context) {
  const EvaluateRequest request{Project::open(flags.project, context.services.pipeline), flags.frames,
                                flags.truth, flags.pictures};
  const auto device = makeDevice(flags.device);
  Progress progress(context.stop, context.console.listener());
  const EvaluateOutcome outcome = evaluate(request, *device, progress);
  context.console.endProgress();
  context.console.print(scoreText(outcome.table));
  if (!flags.json.empty()) writeFileAtomically(flags.json, scoreJson(outcome.table, outcome.each) + "\n");
  keepEvaluation(request.project, outcome);
  return 0;
}

}  // namespace

void addEvaluateCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<EvaluateFlags>();
  CLI::App* command =
      app.add_subcommand("evaluate", "Score a project against ground truth, or its held-out photographs");
  command->add_option("PROJECT", flags->project, "Project folder")->required();
  command->add_option("--ground-truth", flags->truth, "Data set folder with dataset.json and gt/");
  command->add_option("--pictures", flags->pictures,
                      "Score the pictures that render wrote here instead of new ones");
  command->add_option("--frames", flags->frames, "Frames: 0-7, 1,5, 1-9x2 or all that are solved");
  command->add_option("--json", flags->json,
                      "Also write the scores to this file, with every frame's and camera's own");
  addDeviceFlags(*command, flags->device);
  command->callback(
      [flags, &context] { context.action = [flags, &context] { return runEvaluate(*flags, context); }; });
}

}  // namespace beam
