// SPDX-License-Identifier: Apache-2.0
#include "app/cli/run_flags.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <map>

#include "app/cli/answer.h"
#include "app/cli/console_reporter.h"
#include "app/cli/json_reporter.h"
#include "core/base/error.h"
#include "core/base/fields_json.h"
#include "core/base/log.h"
#include "core/base/word_list.h"
#include "core/io/image_file.h"
#include "core/pipeline/machine_times.h"
#include "core/pipeline/path_kind.h"
#include "core/pipeline/run_estimate.h"
#include "core/scene/environment.h"
#include "core/scene/frame_list.h"

namespace beam {
namespace {

std::string keyOf(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw Error(Error::Kind::Usage, fmt::format("--set expects key=value, found \"{}\"", assignment));
  }
  return assignment.substr(0, equals);
}

void setFromText(Project& project, const std::string& assignment) {
  const std::string key = keyOf(assignment);
  project.set(key, parseFieldValue(assignment.substr(key.size() + 1), project.value(key)));
}

}  // namespace

void setForPictures(Project& project, const std::string& assignment) {
  setFromText(project, assignment);
  const std::string key = keyOf(assignment);
  for (const Field& field : project.fields()) {
    if (field.info.name != key || field.info.effect == Effect::Pictures) continue;
    throw Error(
        Error::Kind::Usage,
        fmt::format("--set {}: it changes what is computed, not how it is drawn; beam run --set takes it",
                    assignment));
  }
}

namespace {

void applySettings(Project& project, const ProjectFlags& flags) {
  if (!flags.preset.empty()) project.setPreset(flags.preset);
  if (flags.reset) {
    for (const auto& [key, value] : std::map(project.document().settings)) project.reset(key);
  }
  for (const std::string& key : flags.unset) {
    // One that is set can be taken out whatever it is.
    if (!project.document().settings.contains(key)) project.value(key);  // refuses unknown ones
    for (const std::string& assignment : flags.set) {
      if (keyOf(assignment) != key) continue;
      throw Error(Error::Kind::Usage,
                  fmt::format("--set and --unset both name {}; expected one of them", key));
    }
    project.reset(key);
  }
  for (const std::string& assignment : flags.set) setFromText(project, assignment);
}

// Read whole before anything is written: a project of a panorama that cannot be used would stop at Light.
void requirePanorama(const std::filesystem::path& file) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) {
    throw Error(Error::Kind::Data, fmt::format("--environment expects a panorama (.exr, .hdr); \"{}\" {}",
                                               file.string(), kindInWords(file)));
  }
  const Environment light = makeEnvironment(readRadiance(file));
  if (const std::string doubt = shapeDoubt(light.radiance, file.string()); !doubt.empty())
    logWarning("{}", doubt);
}

// Of this machine in any project, and what the records of this one say.
StepTimes knownTimes(const Project& project) {
  StepTimes times = readMachineTimes();
  times.add(readStepTimes(project));
  return times;
}

int tellPlan(const Project& project, const RunRequest& request, const RunFlags& flags,
             const std::string& command, Console& console) {
  const RunEstimate estimate = estimateRun(project, request, knownTimes(project));
  flags.json ? console.print(signedBy(command, toJson(estimate))) : console.tell(toText(estimate));
  return 0;
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
  command.add_option("--preset", flags.preset, "How much work is put in; a new project has standard")
      ->type_name("NAME");
  command.add_flag("--reset", flags.reset, "Drop what was set before; with --preset the preset alone holds");
  command.add_option("--unset", flags.unset, "Take a setting back to what the preset says")
      ->type_name("KEY")
      ->allow_extra_args(false);
  command
      .add_option("--set", flags.set, "A setting, e.g. --set surface.iterations=2000; see beam help settings")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--environment", flags.environment,
                  "Panorama of the light (.exr, .hdr), latitude-longitude; see beam help environment")
      ->type_name("FILE");
  command.add_option("--hold-out", flags.hold_out, kHoldOutHelp)->type_name("N|NAMES");
  command
      .add_option("--up", flags.up,
                  "Up axis of the capture: +Y, +Z or -Y; else its description or its cameras tell")
      ->type_name("AXIS");
  command.add_option("--unit", flags.unit, kUnitHelp)->type_name("m|cm|mm|NUMBER");
}

void addRunFlags(CLI::App& command, RunFlags& flags) {
  command.add_option("--stage", flags.stage, "Only this stage and what it needs")->type_name("STAGE");
  command.add_option("--until", flags.until, "The last stage to run")
      ->excludes("--stage")
      ->type_name("STAGE");
  command
      .add_option(
          "--frames", flags.frames,
          "Frames such as 0-7; consecutive ones are solved as a take of their own; see beam help frames")
      ->type_name("LIST");
  command
      .add_option("--every", flags.every,
                  "Only every Kth frame, each built on the one K before; steps run for these frames alone")
      ->type_name("K")
      ->check(CLI::Range(1, std::numeric_limits<int>::max()));
  command.add_flag("--dry-run", flags.dry_run,
                   "Say what would be computed and about how long it takes, and change nothing");
  command.add_flag("--json", flags.json,
                   "Print what happens as JSON on standard output, one event a line; of --dry-run the plan");
  addDeviceFlags(command, flags.device);
}

std::vector<std::string> parseHoldOut(const std::string& text) {
  std::vector<std::string> names = splitAtCommas(text);
  if (names.empty()) {
    throw Error(Error::Kind::Usage,
                "--hold-out is empty; expected camera names, every how many (8), or none for no camera");
  }
  if (names.size() == 1 && (lowerCase(names.front()) == "none")) return {};
  return names;
}

void applyFlags(Project& project, const ProjectFlags& flags) {
  applySettings(project, flags);
  if (flags.environment) {
    requirePanorama(*flags.environment);
    project.setEnvironment(*flags.environment);
  }
  if (flags.hold_out) project.setHoldOut(parseHoldOut(*flags.hold_out));
  if (flags.up) project.setUp(parseUpAxis(*flags.up));
  if (flags.unit) project.setUnit(parseUnit(*flags.unit));
}

int runProject(Project project, const RunFlags& flags, const std::string& command, CommandContext& context,
               const std::function<void(const Project&)>& tell_saved) {
  RunRequest request{.stage = flags.stage, .until = flags.until, .every = flags.every};
  if (!isAllFrames(flags.frames)) request.frames = parseFrameList(flags.frames, project.capture().frames);
  if (flags.dry_run) {
    if (tell_saved) tell_saved(project);
    return tellPlan(project, request, flags, command, context.console);
  }
  if (const std::string remark = request.frames.empty() ? "" : remarkOfRun(project, request); !remark.empty())
    context.console.warning(remark);
  makeRunPlan(project, request);  // words and captures that cannot be leave no trace in the project
  std::shared_ptr<ComputeDevice> device = makeDevice(flags.device);
  project.save();
  if (tell_saved) tell_saved(project);
  const Project kept = project;
  Runner runner;
  runner.start(std::move(project), std::move(request), std::move(device));
  ConsoleReporter reporter(context.console, !flags.json);
  JsonReporter events(context.console);
  for (;;) {
    if (context.stop.stop_requested()) runner.requestStop();
    const std::optional<JobEvent> event = runner.waitPop(std::chrono::milliseconds(50));
    if (!event) continue;
    reporter.report(*event);
    if (flags.json) events.report(*event);
    const auto* finished = std::get_if<JobFinished>(&*event);
    if (!finished) continue;
    if (finished->computed > 0) keepMachineTimes(knownTimes(kept));
    return exitCode(*finished);
  }
}

}  // namespace beam
