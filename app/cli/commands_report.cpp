// SPDX-License-Identifier: Apache-2.0
// beam report: the quality of a project over time as one page.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/cli/commands.h"
#include "core/base/count_text.h"
#include "core/work/report.h"

namespace beam {
namespace {

struct ReportFlags {
  std::string project, out;
  bool force = false, strict = false;
  DeviceChoice device;
};

int runReport(const ReportFlags& flags, CommandContext& context) {
  const ReportRequest request{Project::open(flags.project, context.services.pipeline), flags.out, flags.force,
                              flags.strict};
  const auto device = makeDevice(flags.device);
  Progress progress(context.stop, context.console.listener());
  const ReportOutcome outcome = report(request, *device, progress);
  context.console.endProgress();
  for (const std::string& finding : outcome.findings) context.console.warning(finding);
  const std::string of =
      outcome.solved == outcome.frames
          ? countText(outcome.frames, "frame")
          : fmt::format("{}, {} solved", countText(outcome.frames, "frame"), outcome.solved);
  context.console.print(fmt::format("wrote the report of {} to \"{}\"", of, flags.out));
  return 0;
}

}  // namespace

void addReportCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<ReportFlags>();
  CLI::App* command =
      app.add_subcommand("report", "Write the quality of a project over time as one HTML page");
  command->add_option("PROJECT", flags->project, "Project folder")->required();
  command->add_option("--out", flags->out, "The page to write, .html")->required()->type_name("FILE");
  addStrictFlag(*command, flags->strict);
  addForceFlag(*command, flags->force);
  addDeviceFlags(*command, flags->device);
  command->callback(
      [flags, &context] { context.action = [flags, &context] { return runReport(*flags, context); }; });
}

}  // namespace beam
