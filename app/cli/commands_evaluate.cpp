// SPDX-License-Identifier: Apache-2.0
// beam evaluate: scores against ground truth, or of the held-out photographs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iterator>
#include <memory>
#include <span>
#include <string_view>

#include "app/cli/answer.h"
#include "app/cli/commands.h"
#include "core/work/evaluate.h"

namespace beam {
namespace {

struct EvaluateFlags {
  std::string project, truth, pictures, frames = "all";
  AnswerFlags answer;
  bool strict = false;
  DeviceChoice device;
};

constexpr const char* kCommand = "evaluate";

struct Column {
  const char* key;
  int decimals;
  bool operator==(const Column&) const = default;  // of the one table: keys by address
};
constexpr Column kColumns[] = {{"psnr", 3},
                               {"ssim", 4},
                               {"psnr_mask", 3},
                               {"angle_deg", 3},
                               {"mae_mm", 3},
                               {"chamfer_mm", 3},
                               {"pred_to_gt_mm", 3},
                               {"gt_to_pred_mm", 3},
                               {"median_mm", 3},
                               {"p95_mm", 3},
                               {"radiance", 5},
                               {"base_color", 5},
                               {"gaussian_radiance", 5},
                               {"gaussian_base_color", 5},
                               {"pictures", 0}};

std::vector<Column> columnsOf(const Scores& scores) {
  std::vector<Column> columns;
  std::copy_if(std::begin(kColumns), std::end(kColumns), std::back_inserter(columns),
               [&](const Column& c) { return scores.contains(c.key); });
  return columns;
}

std::string cell(const std::string& text, const Column& column) {
  return fmt::format("  {:>{}}", text, std::max<std::size_t>(8, std::string_view(column.key).size()));
}

constexpr std::size_t kLine = 80;

// Columns that fit on a line behind names of this width, in order; at least one a line.
std::vector<std::vector<Column>> folded(const std::vector<Column>& columns, std::size_t name) {
  std::vector<std::vector<Column>> lines;
  std::size_t width = 0;
  for (const Column& c : columns) {
    const std::size_t own = cell(c.key, c).size();
    if (lines.empty() || width + own > kLine) lines.emplace_back(), width = name;
    lines.back().push_back(c);
    width += own;
  }
  return lines;
}

using Row = ScoreTable::value_type;

void addBlock(std::span<const Row> rows, const std::vector<Column>& columns, std::size_t name,
              std::string& text) {
  text += fmt::format("{}{:<{}}", text.empty() ? "" : "\n\n", "", name);
  for (const Column& c : columns) text += cell(c.key, c);
  for (const auto& [map, scores] : rows) {
    text += fmt::format("\n{:<{}}", map, name);
    for (const Column& c : columns) text += cell(fmt::format("{:.{}f}", scores.at(c.key), c.decimals), c);
  }
}

// Neighbouring maps that have the same scores stand below the same heads: no column is empty, and no line
// longer than a terminal is wide.
std::string scoreText(const ScoreTable& table) {
  std::size_t widest = 0;
  for (const auto& [name, scores] : table) widest = std::max(widest, name.size());
  std::string text;
  const std::span<const Row> rows = table;
  for (std::size_t begin = 0, end = 1; begin < rows.size(); begin = end, ++end) {
    const std::vector<Column> columns = columnsOf(rows[begin].second);
    while (end < rows.size() && columnsOf(rows[end].second) == columns) ++end;
    for (const std::vector<Column>& line : folded(columns, widest))
      addBlock(rows.subspan(begin, end - begin), line, widest, text);
  }
  return text;
}

int runEvaluate(const EvaluateFlags& flags, CommandContext& context) {
  const EvaluateRequest request{Project::open(flags.project, context.services.pipeline), flags.frames,
                                flags.truth, flags.pictures, flags.strict};
  requireAnswerTarget(flags.answer, kCommand);
  const auto device = makeDevice(flags.device);
  Progress progress(context.stop, context.console.listener());
  const EvaluateOutcome outcome = evaluate(request, *device, progress);
  context.console.endProgress();
  // Scores took long: they are told, whatever cannot be written.
  std::exception_ptr not_kept;
  try {
    keepEvaluation(request.project, outcome);
  } catch (const Error&) {
    not_kept = std::current_exception();
  }
  answer(
      flags.answer, kCommand, context.console, [&] { return scoreText(outcome.table); },
      [&] { return scoreJson(outcome.table, outcome.each, outcome.origin); });
  if (not_kept) std::rethrow_exception(not_kept);
  return 0;
}

}  // namespace

void addEvaluateCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<EvaluateFlags>();
  CLI::App* command =
      app.add_subcommand("evaluate",
                         "Score a project against ground truth, or its held-out photographs; the scores are "
                         "kept in it as evaluation*.json");
  command->add_option("PROJECT", flags->project, "Project folder")->required();
  command->add_option("--ground-truth", flags->truth, "Data set folder with dataset.json and gt/")
      ->type_name("FOLDER");
  command
      ->add_option("--pictures", flags->pictures,
                   "Score the pictures that render wrote here instead of new ones, against "
                   "--ground-truth; such scores are not kept in the project")
      ->type_name("FOLDER");
  command
      ->add_option("--frames", flags->frames,
                   "Frames such as 0-7, or all that are solved, of --pictures all that are there; see "
                   "beam help frames")
      ->type_name("LIST");
  addStrictFlag(*command, flags->strict);
  addAnswerFlags(*command, flags->answer);
  addDeviceFlags(*command, flags->device);
  command->callback(
      [flags, &context] { context.action = [flags, &context] { return runEvaluate(*flags, context); }; });
}

}  // namespace beam
