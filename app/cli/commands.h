// SPDX-License-Identifier: Apache-2.0
// The commands of `beam`. Each add function declares one subcommand and its flags; its callback sets
// CommandContext::action, which main runs after everything was parsed.
#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/cli/console.h"
#include "app/services.h"

namespace CLI {
class App;
}

namespace beam {

struct CommandContext {
  const Services& services;
  Console& console;
  std::stop_token stop;  // requested on SIGINT, SIGTERM and SIGHUP; give it to Progress
  // Of the command that was typed; returns the exit code, may throw Error, Cancelled.
  std::function<int()> action = {};
  // What is true after a Cancelled of this command.
  std::string interrupted = "interrupted; what was written is whole, the rest is missing";
};

// --force, of commands that write files.
void addForceFlag(CLI::App& command, bool& force);

// --strict, of commands that draw, write or score what is solved: WantedResults::strict.
void addStrictFlag(CLI::App& command, bool& strict);

// --threads N, --simd auto|avx512|avx2|scalar, --device cpu: for every command that computes.
void addDeviceFlags(CLI::App& command, DeviceChoice& choice);

// "beam 0.1.0"; verbose: also what it computes with.
std::string versionWords(const Services& services, bool verbose);

const std::vector<std::string>& rendererNames();  // of --renderer, the usual one first

void addCheckCommand(CLI::App& app, CommandContext& context);
void addCleanCommand(CLI::App& app, CommandContext& context);
void addCompletionCommand(CLI::App& app, CommandContext& context);
void addEvaluateCommand(CLI::App& app, CommandContext& context);
void addExportCommand(CLI::App& app, CommandContext& context);
void addHelpCommand(CLI::App& app, CommandContext& context);  // after those it explains
void addNewCommand(CLI::App& app, CommandContext& context);
void addProcessCommand(CLI::App& app, CommandContext& context);
void addRenderCommand(CLI::App& app, CommandContext& context);
void addReportCommand(CLI::App& app, CommandContext& context);
void addRunCommand(CLI::App& app, CommandContext& context);
void addSampleCommand(CLI::App& app, CommandContext& context);
void addStagesCommand(CLI::App& app, CommandContext& context);
void addStatusCommand(CLI::App& app, CommandContext& context);
void addVersionCommand(CLI::App& app, CommandContext& context);

}  // namespace beam
