// SPDX-License-Identifier: Apache-2.0
#include "app/cli/parse_error.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/cli/flag_facts.h"
#include "app/cli/typed_words.h"
#include "core/base/fields.h"

namespace beam {
namespace {

// The command that was typed, the innermost.
const CLI::App& typedCommand(const CLI::App& app) {
  const std::vector<CLI::App*> typed = app.get_subcommands();
  return typed.empty() ? app : typedCommand(*typed.front());
}

std::string noSuchFlag(const CLI::App& command, const std::string& word) {
  std::vector<std::string> known;
  for (const auto& flags : {flagsOf(command), inheritedFlagsOf(command)}) {
    for (const FlagFacts& f : flags) known.insert(known.end(), f.names.begin(), f.names.end());
  }
  const std::string flag = word.substr(0, word.find('='));
  if (std::find(known.begin(), known.end(), flag) != known.end())
    return fmt::format("\"{}\" stands behind \"--\", where nothing is taken for a flag: move it before that.",
                       flag);
  const std::optional<std::string> similar = similarName(flag, known);
  return fmt::format("there is no flag \"{}\"{}", flag,
                     similar ? fmt::format("; did you mean \"{}\"?", *similar) : std::string("."));
}

std::string noSuchCommand(const CLI::App& app, const std::string& word) {
  if (const std::optional<std::string> meant = meantBy(word); meant && !app.get_parent())
    return fmt::format("there is no command \"{}\"; did you mean {}?", word, *meant);
  std::vector<std::string> known;
  for (const CLI::App* command : commandsOf(app)) known.push_back(command->get_name());
  const std::string list = fmt::format("there are {}", fmt::join(known, ", "));
  return noSuchName("command", word, known, list);
}

// Words that nothing took: a flag first, as what follows it may be its value.
std::string unexpectedText(const CLI::App& app, const CLI::App& command) {
  const std::vector<std::string> words = app.remaining(true);
  if (words.empty()) return {};
  if (&command == &app && !words.front().starts_with('-')) return noSuchCommand(app, words.front());
  const auto flag = std::find_if(words.begin(), words.end(),
                                 [](const std::string& w) { return w.size() > 1 && w.starts_with('-'); });
  if (flag != words.end()) return noSuchFlag(command, *flag);
  if (!commandsOf(command).empty()) return noSuchCommand(command, words.front());
  return fmt::format("\"{}\" is a word too many.", words.front());
}

struct Named {
  const CLI::Option* option = nullptr;
  FlagFacts facts;
};

// What CLI11's message is about: it names the option at its beginning or behind "Could not convert: ".
Named namedIn(const std::string& message, const CLI::App& command) {
  const std::string marker = "Could not convert: ";
  const std::string text = message.starts_with(marker) ? message.substr(marker.size()) : message;
  const std::string name = text.substr(0, text.find_first_of(" :"));
  for (const CLI::App* app = &command; app; app = app->get_parent()) {
    for (const CLI::Option* option : app->get_options({}))
      if (option->get_name() == name) return {option, factsOf(*option)};
  }
  return {};
}

std::string missingText(const FlagFacts& f) {
  if (f.argument) return fmt::format("{} is missing ({}).", f.name(), f.help);
  return fmt::format("{} {} is missing ({}).", f.name(), f.type, f.help);
}

std::string validationText(const Named& named, const std::string& message) {
  const FlagFacts& f = named.facts;
  if (f.range.empty()) {  // of oneOf: a sentence already
    const std::string text = message.substr(std::min(message.size(), f.name().size() + 2));
    return fmt::format("{} {}{}", f.name(), text, text.ends_with('?') ? "" : ".");
  }
  return fmt::format("{} expects {}, found \"{}\".", f.name(), f.range,
                     fmt::join(named.option->results(), ","));
}

std::string namedText(const Named& named, const CLI::ParseError& error) {
  const FlagFacts& f = named.facts;
  const std::string kind = error.get_name();
  if (kind == "RequiredError") return missingText(f);
  if (kind == "ExcludesError") return fmt::format("{} does not go with {}.", f.name(), f.excludes.front());
  if (kind == "ValidationError") return validationText(named, error.what());
  if (kind == "ConversionError" && f.type.empty()) return fmt::format("{} takes no value.", f.name());
  if (kind == "ConversionError")
    return fmt::format("{} expects a number, found \"{}\".", f.name(),
                       fmt::join(named.option->results(), ","));
  if (kind == "ArgumentMismatch") return fmt::format("{} needs a value, {}.", f.name(), f.type);
  return fmt::format("{}.", error.what());
}

}  // namespace

std::string parseErrorText(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = typedCommand(app);
  std::string text = unexpectedText(app, command);
  if (text.empty()) {
    const Named named = namedIn(error.what(), command);
    text = named.option ? namedText(named, error) : fmt::format("{}.", error.what());
  }
  const char* end = text.ends_with('.') || text.ends_with('?') ? " " : ". ";
  return fmt::format("{}: {}{}See {} --help", pathOf(command), text, end, pathOf(command));
}

}  // namespace beam
