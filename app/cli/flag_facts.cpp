// SPDX-License-Identifier: Apache-2.0
#include "app/cli/flag_facts.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>

#include "core/base/fields.h"
#include "core/base/word_list.h"

namespace beam {
namespace {

// What stands behind the words of listOf.
constexpr const char* kList = "...";

// "a,b" of "{a,b}" and of "<a,b>".
std::vector<std::string> wordsOf(const std::string& set) {
  return CLI::detail::split(set.substr(1, set.find_first_of("}>") - 1), ',');
}

// "1 to 8" of CLI::Range's "INT in [1 - 8]".
std::string rangeOf(const std::string& description) {
  static const std::map<std::string, std::string> kNamed = {{"POSITIVE", "above 0"},
                                                            {"NONNEGATIVE", "0 or more"}};
  if (const auto named = kNamed.find(description); named != kNamed.end()) return named->second;
  const std::size_t from = description.find(" in ["), middle = description.find(" - ", from);
  if (from == std::string::npos || middle == std::string::npos) return {};
  const std::string low = description.substr(from + 5, middle - from - 5);
  const std::string high = description.substr(middle + 3, description.size() - middle - 4);
  const bool endless = std::strtod(high.c_str(), nullptr) >= std::numeric_limits<int>::max();
  return endless ? fmt::format("{} or more", low) : fmt::format("{} to {}", low, high);
}

// What CLI11 calls a value whose declaration names no type.
std::string shownType(const std::string& type) {
  static const std::map<std::string, std::string> kWords = {
      {"TEXT", "VALUE"}, {"INT", "N"}, {"UINT", "N"}, {"FLOAT", "NUMBER"}};
  const auto word = kWords.find(type);
  return word == kWords.end() ? type : word->second;
}

// CLI11 says the type and what its validators say, with colons.
void readType(const std::string& text, FlagFacts& facts) {
  const std::size_t colon = text.find(':');
  facts.type = shownType(text.substr(0, colon));
  if (colon == std::string::npos) return;
  for (const std::string& part : CLI::detail::split(text.substr(colon + 1), ':')) {
    if (part.starts_with('{')) {
      facts.choices = wordsOf(part);
      facts.separated = part.ends_with(kList);
    }
    if (part.starts_with('<')) facts.offered = wordsOf(part);
    if (const std::string range = rangeOf(part); !range.empty()) facts.range = range;
  }
}

std::string withoutBrackets(const std::string& text) {
  const bool list = text.size() > 1 && text.front() == '[' && text.back() == ']';
  return list ? text.substr(1, text.size() - 2) : text;
}

std::vector<FlagFacts> factsWhere(const CLI::App& command, bool argument) {
  std::vector<FlagFacts> all;
  for (const CLI::Option* option : command.get_options({})) {
    FlagFacts facts = factsOf(*option);
    if (facts.argument == argument && !facts.group.empty()) all.push_back(std::move(facts));
  }
  return all;
}

void addAllBelow(const CLI::App& app, std::vector<const CLI::App*>& all) {
  for (const CLI::App* command : commandsOf(app)) {
    all.push_back(command);
    addAllBelow(*command, all);
  }
}

// Empty: it is one of them.
std::string complaintOf(const std::string& word, const std::vector<std::string>& words) {
  if (std::find(words.begin(), words.end(), word) != words.end()) return {};
  const std::optional<std::string> similar = similarName(word, words);
  return fmt::format("expects {}, found \"{}\"{}", fmt::join(words, ", "), word,
                     similar ? fmt::format("; did you mean \"{}\"?", *similar) : std::string());
}

std::string setText(const std::vector<std::string>& words) {
  return fmt::format("{{{}}}", fmt::join(words, ","));
}

}  // namespace

FlagFacts factsOf(const CLI::Option& option) {
  FlagFacts facts;
  facts.argument = option.get_positional();
  if (facts.argument) {
    facts.names = {option.get_name(true, false)};
  } else {
    for (const std::string& name : option.get_snames()) facts.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
  }
  facts.help = option.get_description();
  facts.group = option.get_group();
  facts.required = option.get_required();
  if (option.get_type_size() == 0 || option.get_expected_max() == 0) return facts;
  readType(option.get_type_name(), facts);
  facts.initial = withoutBrackets(option.get_default_str());
  facts.separated |= option.get_delimiter() != '\0';
  facts.repeated = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  for (const CLI::Option* other : option.get_excludes()) facts.excludes.push_back(other->get_name());
  std::sort(facts.excludes.begin(), facts.excludes.end());  // CLI11 has them by address
  return facts;
}

std::vector<FlagFacts> argumentsOf(const CLI::App& command) { return factsWhere(command, true); }
std::vector<FlagFacts> flagsOf(const CLI::App& command) { return factsWhere(command, false); }

std::vector<FlagFacts> inheritedFlagsOf(const CLI::App& command) {
  std::vector<FlagFacts> all;
  for (const CLI::App* above = command.get_parent(); above; above = above->get_parent()) {
    for (FlagFacts& facts : flagsOf(*above)) {
      if (facts.name() != "--help" && facts.name() != "--version") all.push_back(std::move(facts));
    }
  }
  return all;
}

std::string pathOf(const CLI::App& command) {
  if (!command.get_parent()) return command.get_name();
  return fmt::format("{} {}", pathOf(*command.get_parent()), command.get_name());
}

std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
  return app.get_subcommands(
      [](const CLI::App* c) { return !c->get_name().empty() && !c->get_group().empty(); });
}

std::vector<const CLI::App*> allCommandsOf(const CLI::App& app) {
  std::vector<const CLI::App*> all;
  addAllBelow(app, all);
  return all;
}

CLI::Validator oneOf(const std::vector<std::string>& words) {
  return CLI::Validator([words](std::string& word) { return complaintOf(word, words); }, setText(words));
}

CLI::Validator listOf(const std::vector<std::string>& words) {
  const auto check = [words](std::string& list) -> std::string {
    for (const std::string& word : splitAtCommas(list))
      if (std::string complaint = complaintOf(word, words); !complaint.empty()) return complaint;
    return {};
  };
  return CLI::Validator(check, setText(words) + kList);
}

CLI::Validator someOf(const std::vector<std::string>& words) { return CLI::Validator(setText(words)); }

CLI::Validator offeringOf(const std::vector<std::string>& words) {
  return CLI::Validator(fmt::format("<{}>", fmt::join(words, ",")));
}

}  // namespace beam
