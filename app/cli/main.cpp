// SPDX-License-Identifier: Apache-2.0
// The program `beam`: parses, runs the command that was typed, turns whatever goes wrong into a message and a
// code.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>

#include "app/cli/commands.h"
#include "app/cli/interrupt.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/io/file.h"

namespace beam {
namespace {

constexpr int kUsage = 2, kInterrupted = 75, kBug = 70;

void addCommands(CLI::App& app, CommandContext& context) {
  addProcessCommand(app, context);
  addNewCommand(app, context);
  addRunCommand(app, context);
  addStatusCommand(app, context);
  addStagesCommand(app, context);
  addCheckCommand(app, context);
  addSampleCommand(app, context);
  addRenderCommand(app, context);
  addEvaluateCommand(app, context);
  addReportCommand(app, context);
  addExportCommand(app, context);
}

// Of a flag that takes one value and is typed twice, the last holds: so that a script can add to a line.
void lastOneWins(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    if (option->get_expected_max() == 1) option->take_last();
  for (CLI::App* command : app.get_subcommands({})) lastOneWins(*command);
}

// The version; with --verbose also what it computes with.
void printVersion(Console& console, bool verbose) {
  console.print(fmt::format("beam {}", versionText()));
  if (!verbose) return;
  console.print(fmt::format("compiler: {}", __VERSION__));
  console.print(fmt::format("device: {}", makeDevice({})->info().title));
  console.print(fmt::format("threads: {}", threadCount()));
}

int parseAndRun(int argc, char** argv, CommandContext& context) {
  Console& console = context.console;
  CLI::App app("BEAM Studio: multi-view video in, relightable Gaussians out", "beam");
  app.require_subcommand(0, 1);
  app.fallthrough();
  bool quiet = false, version = false, verbose = false;
  app.add_flag("--quiet", quiet, "No progress; warnings and errors stay");
  app.add_flag("--verbose", verbose,
               "Details too: reused steps, what was chosen; of --version what it computes with");
  app.add_flag("-V,--version", version, "Print the version and exit");
  addCommands(app, context);
  lastOneWins(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return console.print(app.help()), 0;
    throw Error(Error::Kind::Usage,
                fmt::format("{}; see beam {}--help", e.what(),
                            app.get_subcommands().empty() ? std::string()
                                                          : app.get_subcommands().front()->get_name() + " "));
  }
  console.setQuiet(quiet);
  console.setVerbose(verbose);
  if (version) return printVersion(console, verbose), 0;
  if (!context.action) {
    console.print(app.help());
    return kUsage;
  }
  return context.action();
}

int guarded(int argc, char** argv, Console& console, std::stop_token stop) {
  try {
    const Services services = makeServices();
    CommandContext context{services, console, std::move(stop)};
    try {
      return parseAndRun(argc, argv, context);
    } catch (const Cancelled&) {
      console.endProgress();
      console.info(context.interrupted);
      return kInterrupted;
    }
  } catch (const Error& e) {
    console.error(e.what());
    return exitCode(e.kind());
  } catch (const std::filesystem::filesystem_error& e) {
    const Error storage = storageError(e);
    console.error(storage.what());
    return exitCode(storage.kind());
  } catch (const std::bad_alloc&) {
    console.error("out of memory; close other programs or ask for less");
    return exitCode(Error::Kind::OutOfMemory);
  } catch (const std::exception& e) {
    console.error(fmt::format("this is a bug of beam: {}", e.what()));
    return kBug;
  }
}

}  // namespace
}  // namespace beam

int main(int argc, char** argv) {
  beam::Interrupt interrupt;
  beam::Console console;
  return beam::guarded(argc, argv, console, interrupt.token());
}
