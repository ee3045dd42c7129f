// SPDX-License-Identifier: Apache-2.0
// The program `beam`: parses, runs the command that was typed, turns whatever goes wrong into a message and a
// code.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>
#include <string_view>

#include "app/cli/choices.h"
#include "app/cli/commands.h"
#include "app/cli/exit_codes.h"
#include "app/cli/help_text.h"
#include "app/cli/interrupt.h"
#include "app/cli/parse_error.h"
#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {
namespace {

void addCommands(CLI::App& app, CommandContext& context) {
  addProcessCommand(app, context);
  addNewCommand(app, context);
  addRunCommand(app, context);
  addStatusCommand(app, context);
  addCleanCommand(app, context);
  addStagesCommand(app, context);
  addCheckCommand(app, context);
  addSampleCommand(app, context);
  addRenderCommand(app, context);
  addEvaluateCommand(app, context);
  addReportCommand(app, context);
  addExportCommand(app, context);
  addCompletionCommand(app, context);
  addVersionCommand(app, context);
  addHelpCommand(app, context);
}

// Of a flag that takes one value and is typed twice, the last holds: so that a script can add to a line.
void lastOneWins(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    if (option->get_expected_max() == 1) option->take_last();
  for (CLI::App* command : app.get_subcommands({})) lastOneWins(*command);
}

struct CommonFlags {
  bool quiet = false, version = false, verbose = false;
};

void addCommonFlags(CLI::App& app, CommonFlags& flags) {
  app.set_help_flag("-h,--help", "Print this help");
  app.add_flag("--quiet", flags.quiet, "No progress; warnings and errors stay");
  app.add_flag("--verbose", flags.verbose, "Details too: reused steps, what was chosen");
  app.add_flag("-V,--version", flags.version, "Print the version; with --verbose what it computes with");
}

// Of the command that was typed, the innermost.
std::string typedHelp(const CLI::App& app) {
  const std::vector<CLI::App*> typed = app.get_subcommands();
  return typed.empty() ? helpText(app) : typedHelp(*typed.front());
}

// An unset variable of a script, as a rule: never the same as a flag that was not given.
void requireNoEmptyWord(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& word : option->results())
      if (word.empty())
        throw Error(Error::Kind::Usage,
                    fmt::format("{} is empty; expected {}", option->get_name(), option->get_type_name()));
  }
}

int parseAndRun(int argc, char** argv, CommandContext& context) {
  Console& console = context.console;
  CLI::App app("BEAM Studio: multi-view video in, relightable Gaussians out", "beam");
  app.require_subcommand(0, 1);
  app.fallthrough();
  app.option_defaults()->always_capture_default();  // the help shows them
  CommonFlags flags;
  addCommonFlags(app, flags);
  addCommands(app, context);
  addChoices(app, context.services);
  lastOneWins(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return console.print(typedHelp(app)), kDone;
    throw Error(Error::Kind::Usage, parseErrorText(app, e));
  }
  for (const CLI::App* command : app.get_subcommands()) requireNoEmptyWord(*command);
  console.setQuiet(flags.quiet);
  console.setVerbose(flags.verbose);
  if (flags.version) return console.print(versionWords(context.services, flags.verbose)), kDone;
  if (context.action) return context.action();
  console.print(helpText(app));
  return exitCode(Error::Kind::Usage);
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
    console.error(
        "out of memory; close other programs, or ask for less at once: fewer --cameras, --frames or "
        "--channels, a smaller --size");
    return exitCode(Error::Kind::OutOfMemory);
  } catch (const std::exception& e) {
    console.error(fmt::format("this is a bug of beam: {}", e.what()));
    return exitCode(Error::Kind::Bug);
  }
}

// Not even the words for an error had room.
int endWithoutRoom() noexcept {
  constexpr std::string_view kWords = "error: out of memory; close other programs\n";
  if (::write(STDERR_FILENO, kWords.data(), kWords.size()) < 0) return exitCode(Error::Kind::Storage);
  return exitCode(Error::Kind::OutOfMemory);
}

// Destructors of libraries take memory (nlohmann-json's does, to free what it holds without recursion), and
// where there is none the language ends the program. What was published is whole.
std::terminate_handler g_abort = nullptr;
void endAsWithoutRoom() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    ::_exit(endWithoutRoom());
  } catch (...) {
  }
  g_abort();
}

}  // namespace
}  // namespace beam

int main(int argc, char** argv) try {
  beam::g_abort = std::set_terminate(beam::endAsWithoutRoom);
  beam::Interrupt interrupt;
  beam::Console console;
  const int code = beam::guarded(argc, argv, console, interrupt.token());
  // As the GNU tools have it: done is only what could be told, warnings among it.
  return code == beam::kDone && !console.saidAll() ? beam::exitCode(beam::Error::Kind::Storage) : code;
} catch (const std::exception&) {
  return beam::endWithoutRoom();
}
