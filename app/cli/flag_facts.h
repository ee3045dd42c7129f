// SPDX-License-Identifier: Apache-2.0
// What is known of the commands, flags and arguments of the program, read from their declarations: one
// reading for the help, the completion, the messages and the page of the command line.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace beam {

struct FlagFacts {
  std::vector<std::string> names;  // "-h", "--help"; of an argument the one it has
  std::string help;
  std::string group;                 // heading; "" hides it
  std::string type;                  // of its value, as shown: "LIST"; empty: it takes none
  std::vector<std::string> choices;  // the words it takes, where these are a closed set
  std::vector<std::string> offered;  // beginnings of values that only the completion names: "surface.mesh="
  std::string range;                 // "1 to 4096"
  std::string initial;               // the value when nothing is said
  std::vector<std::string> excludes;
  bool argument = false;  // told by its place, not by a name
  bool required = false;
  bool repeated = false;   // several times
  bool separated = false;  // several values with commas

  const std::string& name() const { return names.back(); }  // the long one
};

FlagFacts factsOf(const CLI::Option& option);

// Those that are not hidden, in order of declaration.
std::vector<FlagFacts> argumentsOf(const CLI::App& command);
std::vector<FlagFacts> flagsOf(const CLI::App& command);
// Flags that a command takes from those above it, without help and version.
std::vector<FlagFacts> inheritedFlagsOf(const CLI::App& command);

// "beam", "beam run".
std::string pathOf(const CLI::App& command);
// Those right below, in order of declaration.
std::vector<const CLI::App*> commandsOf(const CLI::App& app);
// All below, each before those below it.
std::vector<const CLI::App*> allCommandsOf(const CLI::App& app);

// Refuses other words, with the similar one.
CLI::Validator oneOf(const std::vector<std::string>& words);
// Likewise of a list with commas.
CLI::Validator listOf(const std::vector<std::string>& words);
// Words that are shown and completed; others are taken as well.
CLI::Validator someOf(const std::vector<std::string>& words);
// Words that are completed alone: too many to be shown.
CLI::Validator offeringOf(const std::vector<std::string>& words);

}  // namespace beam
