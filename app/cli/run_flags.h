// SPDX-License-Identifier: Apache-2.0
// The flags of `beam process`, `beam new` and `beam run`, and what they do to a project.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "core/pipeline/runner.h"

namespace beam {

// What a project remembers.
struct ProjectFlags {
  std::string preset;
  bool reset = false;                   // what was set before is dropped
  std::vector<std::string> unset, set;  // keys; key=value
  std::optional<std::string> environment, hold_out, up, unit;
};

// What one run is about.
struct RunFlags {
  std::string stage, until, frames = "all";
  int every = 1;
  bool dry_run = false, json = false;
  DeviceChoice device;
};

inline constexpr const char* kUnitHelp =
    "Unit of the capture: m, cm, mm, inch, foot or how many metres one is; else its description or the "
    "subject's height tells";
inline constexpr const char* kHoldOutHelp =
    "Cameras kept for testing: N (every Nth), names and patterns (cam0*) with commas, or none";
// Metres a unit; throws Error{Usage}.
double parseUnit(const std::string& text);

void addProjectFlags(CLI::App& command, ProjectFlags& flags);
void addRunFlags(CLI::App& command, RunFlags& flags);

// Camera names, patterns or one number, with commas; "none": no camera. Throws Error{Usage} for an empty
// list.
std::vector<std::string> parseHoldOut(const std::string& text);

// "key=value" of a setting that changes pictures alone (Effect::Pictures); Error{Usage} for any other.
void setForPictures(Project& project, const std::string& assignment);

// Throws Error{Usage} for unknown presets and settings, Error{Data} for a panorama that is not there or
// cannot be read.
void applyFlags(Project& project, const ProjectFlags& flags);

// Saves the project, runs it and reports until the end; the exit code. What cannot be run is not saved. A dry
// run says what there is to do and saves nothing. `tell_saved` once it is saved, or would be.
int runProject(Project project, const RunFlags& flags, const std::string& command, CommandContext& context,
               const std::function<void(const Project&)>& tell_saved = {});

}  // namespace beam
