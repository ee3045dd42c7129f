// SPDX-License-Identifier: Apache-2.0
// beam process, new, run, status, stages: everything about a project and its runs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cli/answer.h"
#include "app/cli/commands.h"
#include "app/cli/run_flags.h"
#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/pipeline/path_kind.h"
#include "core/pipeline/project_report.h"
#include "core/pipeline/setting_changes.h"
#include "core/pipeline/settings_report.h"
#include "core/work/quality_history.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

Project newProject(const fs::path& folder, const fs::path& capture, const Services& services) {
  requireCaptureFolder(capture);
  Project project = Project::create(folder, {}, services.pipeline);
  project.setCapture(capture);
  return project;
}

// The project at `folder`, made for `capture` when there is none yet.
Project projectFor(const fs::path& folder, const fs::path& capture, const Services& services) {
  if (!Project::isProject(folder)) return newProject(folder, capture, services);
  Project project = Project::open(folder, services.pipeline);
  requireCaptureFolder(capture);
  if (!project.isCapture(capture)) {
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" is a project of another capture, \"{}\"; choose another folder for --out",
                            folder.string(), project.document().capture.absolute));
  }
  project.setCapture(capture);
  return project;
}

// What a capture was taken for, where it is more than turned; once, when its project is made.
void tellPlacement(const Project& project, Console& console) {
  if (isTurn(project.capture().capture_from_world)) return;
  const CapturePlacement& placement = project.imported().placement;
  const bool given = placement.from == UnitFrom::Given;
  console.info(toText(placement) + (given ? "" : " (--unit says otherwise)"));
}

// What was solved in another unit or from another origin is not found any more.
void tellOtherPlacement(const std::optional<CapturePlacement>& before, const Project& project,
                        Console& console) {
  if (!before) return;
  const CapturePlacement now = project.imported().placement;
  if (now.unit_m == before->unit_m && now.origin == before->origin) return;
  console.warning(fmt::format("{} (before: {}); what was solved for that is kept and does not apply now",
                              toText(now), toText(*before)));
}

void tellChanges(const Project& before, const Project& project, bool dry_run, Console& console) {
  tellOtherPlacement(before.world(), project, console);
  std::vector<std::string> changes;
  try {
    changes = settingChanges(before, project);
  } catch (const Error&) {
    return;  // what was saved before could not be, and was mended
  }
  if (!changes.empty())
    console.info(fmt::format("{}: {}", dry_run ? "would be saved" : "saved", fmt::join(changes, ", ")));
}

// Where project.json and the capture are not of one another any more; gives whether the description of the
// capture differs.
bool warnOfCapture(const Project& project, Console& console) {
  const std::string change = project.captureChange();
  if (!change.empty()) {
    console.warning(
        fmt::format("the capture \"{}\" is not described as it was when the project took it in: {}",
                    project.captureFolder().string(), change));
  }
  for (const std::string& take : takesNotUnderstood(project.document().takes, project.capture().frames))
    console.warning(take);
  return !change.empty();
}

std::string statusWords(const Project& project, const DiskUse& use) {
  std::string text = statusText(project);
  if (const std::string disk = diskText(use); !disk.empty()) text += fmt::format("\n{}", disk);
  for (const LeftOutCamera& c : leftOutCameras(project))
    text += fmt::format("\nleft out of the fit: {}", toText(c, {}));
  return text;
}

std::string statusAsJson(const Project& project, const DiskUse& use) {
  nlohmann::ordered_json j = nlohmann::ordered_json::parse(statusJson(project));
  j["disk"] = nlohmann::ordered_json::parse(diskJson(use));
  j["left_out"] = nlohmann::ordered_json::array();
  for (const LeftOutCamera& c : leftOutCameras(project))
    j["left_out"].push_back(
        {{"camera", c.camera}, {"kind", toText(c.kind)}, {"frames", c.frames}, {"text", c.text}});
  return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

constexpr const char* kCaptureHelp = "Folder of the capture; it is only read; see beam help captures";

struct ProcessArguments {
  std::string capture, project;
  ProjectFlags project_flags;
  RunFlags run;
};

}  // namespace

void addProcessCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("process", "Import a capture and run what is missing; resumes");
  auto a = std::make_shared<ProcessArguments>();
  command->add_option("CAPTURE", a->capture, kCaptureHelp)->required();
  command->add_option("--out", a->project, "Project folder, Name.beam")->required()->type_name("PROJECT");
  addProjectFlags(*command, a->project_flags);
  addRunFlags(*command, a->run);
  command->callback([a, &context] {
    context.action = [a, &context] {
      const bool made = !Project::isProject(a->project);
      Project project = projectFor(a->project, a->capture, context.services);
      const Project before = project;
      applyFlags(project, a->project_flags);
      if (made) tellPlacement(project, context.console);
      return runProject(std::move(project), a->run, "process", context, [&](const Project& saved) {
        if (!made) tellChanges(before, saved, a->run.dry_run, context.console);
      });
    };
  });
}

void addNewCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("new", "Make a project of a capture without running anything");
  auto a = std::make_shared<ProcessArguments>();
  command->add_option("PROJECT", a->project, "Project folder, Name.beam")->required();
  command->add_option("--capture", a->capture, kCaptureHelp)->required()->type_name("CAPTURE");
  addProjectFlags(*command, a->project_flags);
  command->callback([a, &context] {
    context.action = [a, &context] {
      Project project = newProject(a->project, a->capture, context.services);
      applyFlags(project, a->project_flags);
      const CaptureSet& capture = project.capture();
      tellPlacement(project, context.console);
      project.save();
      context.console.print(fmt::format("made {} ({}, {})", a->project,
                                        countText(capture.views.size(), "camera"),
                                        countText(capture.frames.size(), "frame")));
      return 0;
    };
  });
}

void addRunCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("run", "Run what is missing of a project");
  auto a = std::make_shared<ProcessArguments>();
  command->add_option("PROJECT", a->project, "Project folder")->required();
  addProjectFlags(*command, a->project_flags);
  addRunFlags(*command, a->run);
  command->callback([a, &context] {
    context.action = [a, &context] {
      Project project = Project::open(a->project, context.services.pipeline);
      const Project before = project;
      applyFlags(project, a->project_flags);
      if (warnOfCapture(project, context.console)) project.acceptCaptureChange();
      return runProject(std::move(project), a->run, "run", context, [&](const Project& saved) {
        tellChanges(before, saved, a->run.dry_run, context.console);
      });
    };
  });
}

void addStatusCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("status", "What of a project is done");
  auto folder = std::make_shared<std::string>();
  auto flags = std::make_shared<AnswerFlags>();
  command->add_option("PROJECT", *folder, "Project folder")->required();
  addAnswerFlags(*command, *flags);
  command->callback([folder, flags, &context] {
    context.action = [folder, flags, &context] {
      const Project project = Project::open(*folder, context.services.pipeline);
      requireAnswerTarget(*flags, "status");
      warnOfCapture(project, context.console);
      context.interrupted = "interrupted; nothing was written";
      Progress progress(context.stop, context.console.listener());
      const DiskUse use = diskUse(project, progress);
      context.console.endProgress();
      answer(
          *flags, "status", context.console, [&] { return statusWords(project, use); },
          [&] { return statusAsJson(project, use); });
      return 0;
    };
  });
}

void addStagesCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "stages", "The stages, their steps and every setting; of a project with the values in force");
  auto folder = std::make_shared<std::string>();
  auto flags = std::make_shared<AnswerFlags>();
  command->add_option("PROJECT", *folder, "Project folder; without one what the presets say");
  addAnswerFlags(*command, *flags);
  command->callback([folder, flags, &context] {
    context.action = [folder, flags, &context] {
      const std::shared_ptr<const PipelineSetup>& setup = context.services.pipeline;
      std::optional<Project> project;
      if (!folder->empty()) project = Project::open(*folder, setup);
      const Project* of = project ? &*project : nullptr;
      requireAnswerTarget(*flags, "stages");
      answer(
          *flags, "stages", context.console, [&] { return stagesText(*setup, of); },
          [&] { return stagesJson(*setup, of); });
      return 0;
    };
  });
}

}  // namespace beam
