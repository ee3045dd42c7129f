// SPDX-License-Identifier: Apache-2.0
// beam help, beam version and beam completion: what the program says about itself.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/completion.h"
#include "app/cli/flag_facts.h"
#include "app/cli/help_text.h"
#include "app/cli/help_topics.h"
#include "core/base/error.h"
#include "core/base/fields.h"
#include "core/base/parallel.h"

namespace beam {
namespace {

struct HelpFlags {
  std::vector<std::string> words;
  bool list = false, json = false, markdown = false;
};

std::vector<std::string> topicNames() {
  std::vector<std::string> names;
  for (const HelpTopic& topic : helpTopics()) names.emplace_back(topic.name);
  return names;
}

std::vector<std::string> commandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : commandsOf(app)) names.push_back(command->get_name());
  return names;
}

std::string helpOf(const CLI::App& app, const std::string& word) {
  for (const HelpTopic& topic : helpTopics())
    if (word == topic.name) return topic.text();
  for (const CLI::App* command : commandsOf(app))
    if (word == command->get_name()) return helpText(*command);
  throw Error(Error::Kind::Bug, fmt::format("no help of \"{}\"", word));
}

void requireKnown(const CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> known = commandNames(app);
  for (const std::string& topic : topicNames()) known.push_back(topic);
  for (const std::string& word : words) {
    if (std::find(known.begin(), known.end(), word) != known.end()) continue;
    throw Error(Error::Kind::Usage,
                fmt::format("beam help: {} Topics: {}. Commands: {}.",
                            noSuchName("topic or command", word, known, "there are these."),
                            fmt::join(topicNames(), ", "), fmt::join(commandNames(app), ", ")));
  }
}

std::string pathList(const CLI::App& app) {
  std::vector<std::string> paths;
  for (const CLI::App* command : allCommandsOf(app)) paths.push_back(pathOf(*command));
  return fmt::format("{}", fmt::join(paths, "\n"));
}

std::string helpAnswer(const CLI::App& app, const HelpFlags& flags) {
  requireKnown(app, flags.words);
  if (!flags.words.empty() && (flags.list || flags.markdown)) {
    throw Error(Error::Kind::Usage, fmt::format("beam help: --{} is of everything; leave \"{}\" away",
                                                flags.list ? "list" : "markdown", flags.words.front()));
  }
  if (flags.json) return helpJson(app, flags.words);
  if (flags.markdown) return helpMarkdown(app);
  if (flags.list) return pathList(app);
  if (flags.words.empty()) return helpText(app);
  std::vector<std::string> pages;
  for (const std::string& word : flags.words) pages.push_back(helpOf(app, word));
  return fmt::format("{}", fmt::join(pages, "\n\n"));
}

}  // namespace

std::string versionWords(const Services& services, bool verbose) {
  std::string words = fmt::format("beam {}", versionText());
  if (!verbose) return words;
  words += fmt::format("\ncompiler: {}", __VERSION__);
  words += fmt::format("\ndevice: {}", makeDevice({})->info().title);
  words += fmt::format("\nthreads: {}", threadCount());
  return words + fmt::format("\nresources: {}", services.resources.string());
}

void addHelpCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<HelpFlags>();
  CLI::App* command = app.add_subcommand("help", "Explain a command or a topic");
  std::vector<std::string> words = topicNames();
  for (const std::string& name : commandNames(app)) words.push_back(name);
  command->add_option("TOPIC", flags->words, "Topics and commands; the overview when nothing is said")
      ->check(someOf(words));
  command->add_flag("--list", flags->list, "Print every command, one a line");
  command->add_flag("--json", flags->json,
                    "Print every command, flag and example as JSON; those of TOPIC alone where it is named");
  command->add_flag("--markdown", flags->markdown, "Print all help as one Markdown page")->group("");
  command->callback([flags, &app, &context] {
    context.action = [flags, &app, &context] {
      context.console.print(helpAnswer(app, *flags));
      return 0;
    };
  });
}

void addVersionCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command =
      app.add_subcommand("version", "Print the version; with --verbose what it computes with");
  command->callback([&context, verbose = app.get_option("--verbose")] {
    context.action = [&context, verbose] {
      context.console.print(versionWords(context.services, verbose->count() > 0));
      return 0;
    };
  });
}

void addCompletionCommand(CLI::App& app, CommandContext& context) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("completion", "Print the script that completes beam in a shell");
  command->add_option("SHELL", *shell, "The shell")->required()->check(oneOf(completedShells()));
  command->callback([shell, &app, &context] {
    context.action = [shell, &app, &context] {
      context.console.print(completionScript(app, *shell));
      return 0;
    };
  });
}

}  // namespace beam
