// SPDX-License-Identifier: Apache-2.0
#include "app/cli/help_text.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/cli/examples.h"
#include "app/cli/exit_codes.h"
#include "app/cli/flag_facts.h"
#include "app/cli/help_page.h"
#include "app/cli/help_topics.h"
#include "app/cli/json_keys.h"

namespace beam {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kCommandColumns = 12;

std::string usageOf(const CLI::App& command) {
  std::string usage = pathOf(command);
  for (const FlagFacts& a : argumentsOf(command)) {
    const std::string name = fmt::format("{}{}", a.name(), a.repeated ? "..." : "");
    usage += a.required ? fmt::format(" {}", name) : fmt::format(" [{}]", name);
  }
  for (const FlagFacts& f : flagsOf(command))
    if (f.required) usage += fmt::format(" {} {}", f.name(), f.type);
  if (!commandsOf(command).empty()) return usage + " COMMAND [flags]";
  return usage + " [flags]";
}

std::string nameText(const FlagFacts& f) {
  const std::string names = fmt::format("{}", fmt::join(f.names, ", "));
  if (f.argument || f.type.empty()) return names;
  return fmt::format("{} {}{}", names, f.type, f.separated ? ",..." : "");
}

// The help and, in parentheses, what the declaration adds.
std::string meaningText(const FlagFacts& f) {
  std::vector<std::string> facts;
  if (f.required) facts.emplace_back("required");
  if (f.choices.size() == 1 && f.initial.empty()) facts.push_back(f.choices.front());
  if (f.choices.size() > 1)
    facts.push_back(fmt::format("{} {}", f.separated ? "some of" : "one of", fmt::join(f.choices, ", ")));
  if (!f.range.empty()) facts.push_back(f.range);
  if (!f.initial.empty()) facts.push_back(fmt::format("default: {}", f.initial));
  if (f.repeated && !f.separated && !f.argument) facts.emplace_back("may stand several times");
  if (!f.excludes.empty()) facts.push_back(fmt::format("not with {}", fmt::join(f.excludes, ", ")));
  return facts.empty() ? f.help : fmt::format("{} ({})", f.help, fmt::join(facts, "; "));
}

void addRows(HelpPage& page, std::string_view heading, const std::vector<FlagFacts>& rows) {
  if (rows.empty()) return;
  page.heading(heading);
  for (const FlagFacts& f : rows) page.row(nameText(f), meaningText(f));
}

// One heading a group, in order of first mention; CLI11's own first group is called "Options".
void addFlags(HelpPage& page, const CLI::App& command) {
  std::vector<std::pair<std::string, std::vector<FlagFacts>>> groups;
  for (const FlagFacts& f : flagsOf(command)) {
    const std::string title = f.group == "Options" ? "Flags" : f.group;
    const auto known =
        std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == title; });
    if (known == groups.end())
      groups.push_back({title, {f}});
    else
      known->second.push_back(f);
  }
  for (const auto& [title, flags] : groups) addRows(page, title, flags);
  addRows(page, "Flags of every command", inheritedFlagsOf(command));
}

void addCommands(HelpPage& page, const CLI::App& app) {
  const std::vector<const CLI::App*> commands = commandsOf(app);
  if (commands.empty()) return;
  page.heading("Commands");
  HelpPage rows(kCommandColumns);
  for (const CLI::App* c : commands) rows.row(c->get_name(), c->get_description());
  page.append(rows);
}

void addTopics(HelpPage& page) {
  page.heading("Topics, with beam help TOPIC");
  HelpPage rows(kCommandColumns);
  for (const HelpTopic& topic : helpTopics()) rows.row(topic.name, topic.summary);
  page.append(rows);
}

void addExamples(HelpPage& page, const std::vector<Example>& examples) {
  if (examples.empty()) return;
  page.heading("Examples");
  for (const Example& e : examples) page.example(e.line, e.what);
}

Json jsonOf(const FlagFacts& f) {
  Json j = {{"names", f.names}, {"help", f.help}, {"required", f.required}};
  if (!f.type.empty()) j["type"] = f.type;
  if (!f.choices.empty()) j["choices"] = f.choices;
  if (!f.range.empty()) j["range"] = f.range;
  if (!f.initial.empty()) j["default"] = f.initial;
  return j;
}

Json jsonOf(const std::vector<FlagFacts>& all) {
  Json j = Json::array();
  for (const FlagFacts& f : all) j.push_back(jsonOf(f));
  return j;
}

Json commandJson(const CLI::App& command) {
  Json j = {{"command", pathOf(command)},        {"summary", command.get_description()},
            {"usage", usageOf(command)},         {"arguments", jsonOf(argumentsOf(command))},
            {"flags", jsonOf(flagsOf(command))}, {"examples", Json::array()}};
  for (const Example& e : examplesOf(pathOf(command)))
    j["examples"].push_back({{"line", e.line}, {"what", e.what}});
  return j;
}

}  // namespace

std::string helpText(const CLI::App& command) {
  HelpPage page;
  page.paragraph(command.get_description());
  page.blank();
  page.paragraph(fmt::format("Usage: {}", usageOf(command)));
  addRows(page, "Arguments", argumentsOf(command));
  addCommands(page, command);
  if (!command.get_parent()) addTopics(page);
  addFlags(page, command);
  addExamples(page, examplesOf(pathOf(command)));
  return page.text();
}

std::string helpJson(const CLI::App& app, const std::vector<std::string>& words) {
  const auto wanted = [&](const std::string& name) {
    return words.empty() || std::find(words.begin(), words.end(), name) != words.end();
  };
  Json j = {{"commands", Json::array()}, {"topics", Json::array()}};
  if (words.empty()) j["commands"].push_back(commandJson(app));
  for (const CLI::App* command : allCommandsOf(app))
    if (wanted(command->get_name())) j["commands"].push_back(commandJson(*command));
  for (const HelpTopic& topic : helpTopics())
    if (wanted(topic.name))
      j["topics"].push_back({{"topic", topic.name}, {"summary", topic.summary}, {"text", topic.text()}});
  for (const ExitCodeInfo& e : exitCodes())
    j["exit_codes"].push_back({{"code", e.code}, {"meaning", e.meaning}, {"advice", e.advice}});
  for (const JsonAnswer& answer : jsonAnswers()) {
    if (!wanted(answer.command.substr(0, answer.command.find(' ')))) continue;
    Json keys = Json::object();
    for (const JsonKey& key : answer.keys) keys[key.path] = key.meaning;
    j["json"][answer.command] = std::move(keys);
  }
  return j.dump(1);
}

std::string helpMarkdown(const CLI::App& app) {
  std::string page =
      "# The command line\n\nWhat `beam help COMMAND` and `beam help TOPIC` say, on one page. The program "
      "wrote it:\n"
      "`beam help --markdown > resources/command-line.md`.\n";
  const auto add = [&](const std::string& title, const std::string& text) {
    page += fmt::format("\n## {}\n\n```\n{}\n```\n", title, text);
  };
  add("beam", helpText(app));
  for (const CLI::App* command : allCommandsOf(app)) add(pathOf(*command), helpText(*command));
  for (const HelpTopic& topic : helpTopics()) add(fmt::format("beam help {}", topic.name), topic.text());
  page.pop_back();
  return page;
}

}  // namespace beam
