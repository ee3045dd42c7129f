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

// Of a topic or of a command, several words for one below another.
std::string helpOf(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return helpText(app);
  for (const HelpTopic& topic : helpTopics())
    if (words.size() == 1 && words.front() == topic.name) return topic.text();
  const CLI::App* command = &app;
  for (const std::string& word : words) {
    const std::vector<const CLI::App*> below = commandsOf(*command);
    const auto found =
        std::find_if(below.begin(), below.end(), [&](const CLI::App* c) { return c->get_name() == word; });
    if (found == below.end()) {
      std::vector<std::string> known = commandNames(*command);
      for (const std::string& topic : topicNames()) known.push_back(topic);
      throw Error(Error::Kind::Usage,
                  fmt::format("beam help: {} Topics: {}. Commands: {}.",
                              noSuchName("topic or command", word, known, "there are these."),
                              fmt::join(topicNames(), ", "), fmt::join(commandNames(*command), ", ")));
    }
    command = *found;
  }
  return helpText(*command);
}

std::string pathList(const CLI::App& app) {
  std::vector<std::string> paths;
  for (const CLI::App* command : allCommandsOf(app)) paths.push_back(pathOf(*command));
  return fmt::format("{}", fmt::join(paths, "\n"));
}

std::string helpAnswer(const CLI::App& app, const HelpFlags& flags) {
  if (flags.json) return helpJson(app);
  if (flags.markdown) return helpMarkdown(app);
  return flags.list ? pathList(app) : helpOf(app, flags.words);
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
  command->add_option("TOPIC", flags->words, "A topic or a command; the overview when nothing is said")
      ->check(someOf(words));
  command->add_flag("--list", flags->list, "Print every command, one a line");
  command->add_flag("--json", flags->json, "Print every command, flag and example as JSON");
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
