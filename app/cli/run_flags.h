// SPDX-License-Identifier: Apache-2.0
// The flags of `beam process`, `beam new` and `beam run`, and what they do to a project.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "core/pipeline/runner.h"

namespace beam {

// What a project remembers.
struct ProjectFlags {
  std::string preset;
  std::vector<std::string> set;  // key=value
  std::optional<std::string> environment, hold_out, up, unit;
};

// What one run is about.
struct RunFlags {
  std::string stage, until, frames = "all";
  int every = 1;
  DeviceChoice device;
};

inline constexpr const char* kUnitHelp =
    "Unit of the capture: m, cm, mm, inch, foot or metres a unit; else its description or the subject's "
    "height "
    "tells";
// Metres a unit; throws Error{Usage}.
double parseUnit(const std::string& text);

void addProjectFlags(CLI::App& command, ProjectFlags& flags);
void addRunFlags(CLI::App& command, RunFlags& flags);

// Throws Error{Usage} for unknown presets and settings, Error{Data} for a panorama that is not there.
void applyFlags(Project& project, const ProjectFlags& flags);

// Saves the project, runs it and reports until the end; the exit code. What cannot be run is not saved.
int runProject(Project project, const RunFlags& flags, CommandContext& context);

}  // namespace beam
