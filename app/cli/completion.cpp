// SPDX-License-Identifier: Apache-2.0
#include "app/cli/completion.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/cli/flag_facts.h"
#include "core/base/error.h"

namespace beam {
namespace {

// What a value is completed with.
enum class Takes { Nothing, Words, Beginnings, Files, Folders };

Takes takesOf(const FlagFacts& f) {
  if (!f.choices.empty()) return Takes::Words;
  if (!f.offered.empty()) return Takes::Beginnings;
  for (const char* folder : {"FOLDER", "PROJECT", "CAPTURE"}) {
    if (f.type == folder || (f.argument && f.name() == folder)) return Takes::Folders;
  }
  if (f.argument || f.type == "FILE" || f.type == "PATH") return Takes::Files;
  return Takes::Nothing;
}

// Of a shell: how its script offers things. The rest of both scripts is the same.
struct Shell {
  const char* head;
  const char* words;       // offers words, one of which may follow a comma: {0} the words
  const char* separated;   // likewise, behind commas
  const char* beginnings;  // likewise, with more to be typed behind one
  const char* files;
  const char* folders;
  const char* foot;
};

constexpr Shell kBash = {
    R"(# Completion of beam in bash; written by: beam completion bash
_beam() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev="" command="" word i
  [ "$COMP_CWORD" -gt 0 ] && prev=${{COMP_WORDS[COMP_CWORD-1]}}
  if [ "$cur" = "=" ]; then
    cur=""
  elif [ "$prev" = "=" ] && [ "$COMP_CWORD" -gt 1 ]; then
    prev=${{COMP_WORDS[COMP_CWORD-2]}}
  fi
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${{COMP_WORDS[i]}}
    case "$command $word" in
{}    esac
  done
)",
    R"(COMPREPLY=($(compgen -W "{}" -- "$cur")))",
    R"(word=${{cur%"${{cur##*,}}"}}; COMPREPLY=($(compgen -P "$word" -W "{}" -- "${{cur##*,}}")))",
    R"(compopt -o nospace 2>/dev/null; COMPREPLY=($(compgen -W "{}" -- "$cur")))",
    R"(compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -f -- "$cur")))",
    R"(compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -d -- "$cur")))",
    "complete -F _beam beam\n"};

constexpr Shell kZsh = {
    R"(#compdef beam
# Completion of beam in zsh; written by: beam completion zsh
_beam() {{
  local cur=${{words[CURRENT]}} prev=${{words[CURRENT-1]}} command="" word i
  if [[ "$cur" == --*=* ]]; then
    prev=${{cur%%=*}}
    compset -P '*='
    cur=${{cur#*=}}
  fi
  for ((i = 2; i < CURRENT; ++i)); do
    word=${{words[i]}}
    case "$command $word" in
{}    esac
  done
)",
    R"(compadd -- {})",
    R"(compset -P '*,'; compadd -S '' -- {})",
    R"(compadd -S '' -- {})",
    "_files",
    "_files -/",
    R"(if [ "$funcstack[1]" = "_beam" ]; then
  _beam "$@"
else
  compdef _beam beam
fi
)"};

// "run" of "beam run", "" of "beam".
std::string below(const CLI::App& command) {
  const std::string path = pathOf(command);
  const std::size_t blank = path.find(' ');
  return blank == std::string::npos ? std::string() : path.substr(blank + 1);
}

std::string offer(const Shell& shell, const FlagFacts& f) {
  switch (takesOf(f)) {
    case Takes::Words:
      return fmt::format(fmt::runtime(f.separated ? shell.separated : shell.words),
                         fmt::join(f.choices, " "));
    case Takes::Beginnings:
      return fmt::format(fmt::runtime(shell.beginnings), fmt::join(f.offered, " "));
    case Takes::Files:
      return shell.files;
    case Takes::Folders:
      return shell.folders;
    case Takes::Nothing:
      break;
  }
  return ":";
}

std::string namesOf(const std::vector<FlagFacts>& flags) {
  std::string names;
  for (const FlagFacts& f : flags) names += fmt::format("{} ", fmt::join(f.names, " "));
  return names;
}

std::vector<FlagFacts> allFlagsOf(const CLI::App& command) {
  std::vector<FlagFacts> flags = flagsOf(command);
  for (FlagFacts& f : inheritedFlagsOf(command)) flags.push_back(std::move(f));
  return flags;
}

// `"run --preset") ... return;;` of every flag with a value.
std::string valueCases(const Shell& shell, const CLI::App& command) {
  std::string text;
  for (const FlagFacts& f : allFlagsOf(command)) {
    if (f.type.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : f.names)
      patterns.push_back(fmt::format("\"{} {}\"", below(command), name));
    text += fmt::format("    {}) {}; return ;;\n", fmt::join(patterns, "|"), offer(shell, f));
  }
  return text;
}

// What can stand where no flag and no value is asked for.
std::string wordCase(const Shell& shell, const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::App* c : commandsOf(command)) words.push_back(c->get_name());
  std::string offers;
  for (const FlagFacts& f : argumentsOf(command)) {
    if (takesOf(f) == Takes::Words)
      words.insert(words.end(), f.choices.begin(), f.choices.end());
    else
      offers = offer(shell, f);
  }
  if (!words.empty()) offers = fmt::format(fmt::runtime(shell.words), fmt::join(words, " "));
  return fmt::format("    \"{}\") {} ;;\n", below(command), offers.empty() ? ":" : offers);
}

std::string flagCase(const Shell& shell, const CLI::App& command) {
  std::string names = namesOf(allFlagsOf(command));
  if (!names.empty()) names.pop_back();
  return fmt::format("      \"{}\") {} ;;\n", below(command), fmt::format(fmt::runtime(shell.words), names));
}

std::string script(const CLI::App& app, const Shell& shell) {
  std::vector<const CLI::App*> commands = allCommandsOf(app);
  std::string found, values, flags, words;
  for (const CLI::App* c : commands)
    found += fmt::format("      \"{} {}\") command=\"{}\" ;;\n", below(*c->get_parent()), c->get_name(),
                         below(*c));
  commands.insert(commands.begin(), &app);
  for (const CLI::App* c : commands) {
    values += valueCases(shell, *c);
    flags += flagCase(shell, *c);
    words += wordCase(shell, *c);
  }
  return fmt::format(fmt::runtime(shell.head), found) +
         fmt::format("  case \"$command $prev\" in\n{}  esac\n", values) +
         fmt::format("  case \"$cur\" in\n    -*) case \"$command\" in\n{}    esac\n    return ;;\n  esac\n",
                     flags) +
         fmt::format("  case \"$command\" in\n{}  esac\n}}\n", words) + shell.foot;
}

}  // namespace

std::vector<std::string> completedShells() { return {"bash", "zsh"}; }

std::string completionScript(const CLI::App& app, const std::string& shell) {
  std::string text;
  if (shell == "bash")
    text = script(app, kBash);
  else if (shell == "zsh")
    text = script(app, kZsh);
  else
    throw Error(Error::Kind::Usage, fmt::format("there is no completion for \"{}\" (there are {})", shell,
                                                fmt::join(completedShells(), ", ")));
  text.pop_back();
  return text;
}

}  // namespace beam
