// SPDX-License-Identifier: Apache-2.0
#include "app/cli/run_flags.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <sstream>

#include "app/cli/console_reporter.h"
#include "core/base/error.h"
#include "core/base/fields_json.h"
#include "core/scene/frame_list.h"

namespace beam {
namespace {

std::vector<std::string> splitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

void setFromText(Project& project, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw Error(Error::Kind::Usage, fmt::format("--set expects key=value, found \"{}\"", assignment));
  }
  project.set(assignment.substr(0, equals), parseFieldValue(assignment.substr(equals + 1)));
}

}  // namespace

double parseUnit(const std::string& text) {
  if (const std::optional<double> unit_m = unitNamed(text)) return *unit_m;
  throw Error(
      Error::Kind::Usage,
      fmt::format("--unit expects m, cm, mm, inch, foot or metres a unit, a number above 0; found \"{}\"",
                  text));
}

void addProjectFlags(CLI::App& command, ProjectFlags& flags) {
  command.add_option("--preset", flags.preset, "draft, standard (when nothing is said) or paper");
  command.add_option("--set", flags.set, "A setting, e.g. --set surface.iterations=2000; see beam stages")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--environment", flags.environment,
                  "Panorama of the light (.exr, .hdr), latitude-longitude")
      ->type_name("FILE");
  command
      .add_option("--hold-out", flags.hold_out, "Cameras kept for testing: N (every Nth), NAME,NAME or none")
      ->type_name("N|NAMES");
  command.add_option("--up", flags.up, "Up axis of the capture: +Y, +Z or -Y")->type_name("AXIS");
  command.add_option("--unit", flags.unit, kUnitHelp)->type_name("m|cm|mm|NUMBER");
}

void addRunFlags(CLI::App& command, RunFlags& flags) {
  command.add_option("--stage", flags.stage, "Only this stage and what it needs");
  command.add_option("--until", flags.until, "The last stage to run")->excludes("--stage");
  command
      .add_option("--frames", flags.frames,
                  "Frames: 0-7, 1,5, 1-9x2 or all; consecutive ones are solved as a take of their own")
      ->type_name("LIST");
  command
      .add_option("--every", flags.every,
                  "Only every Kth frame, each built on the one K before; steps run for these frames alone")
      ->type_name("K");
  addDeviceFlags(command, flags.device);
}

void applyFlags(Project& project, const ProjectFlags& flags) {
  if (!flags.preset.empty()) project.setPreset(flags.preset);
  for (const std::string& assignment : flags.set) setFromText(project, assignment);
  if (flags.environment) {
    if (!std::filesystem::is_regular_file(*flags.environment)) {
      throw Error(Error::Kind::Data, fmt::format("the panorama \"{}\" is not there", *flags.environment));
    }
    project.setEnvironment(*flags.environment);
  }
  if (flags.hold_out) {
    project.setHoldOut(*flags.hold_out == "none" ? std::vector<std::string>{}
                                                 : splitAtCommas(*flags.hold_out));
  }
  if (flags.up) project.setUp(parseUpAxis(*flags.up));
  if (flags.unit) project.setUnit(parseUnit(*flags.unit));
}

int runProject(Project project, const RunFlags& flags, CommandContext& context) {
  RunRequest request{.stage = flags.stage, .until = flags.until, .every = flags.every};
  if (flags.frames != "all") request.frames = parseFrameList(flags.frames, project.capture().frames);
  makeRunPlan(project, request);  // words and captures that cannot be leave no trace in the project
  std::shared_ptr<ComputeDevice> device = makeDevice(flags.device);
  project.save();
  Runner runner;
  runner.start(std::move(project), std::move(request), std::move(device));
  ConsoleReporter reporter(context.console);
  for (;;) {
    if (context.stop.stop_requested()) runner.requestStop();
    const std::optional<JobEvent> event = runner.waitPop(std::chrono::milliseconds(50));
    if (!event) continue;
    reporter.report(*event);
    if (const auto* finished = std::get_if<JobFinished>(&*event)) return exitCode(*finished);
  }
}

}  // namespace beam
