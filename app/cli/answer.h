// SPDX-License-Identifier: Apache-2.0
// What a command answers, one way for all: words on standard output, with --json the same as JSON there
// instead, with --json-file as JSON in a file beside the words.
#pragma once

#include <functional>
#include <string>

#include "app/cli/commands.h"

namespace beam {

struct AnswerFlags {
  bool json = false;
  std::string json_file;  // "-": standard output, as --json
  bool force = false;     // the file is replaced even where another program wrote it
};

// --json, --json-file FILE and --force.
void addAnswerFlags(CLI::App& command, AnswerFlags& flags);

// `json`, an object, with who wrote it in front.
std::string signedBy(const std::string& command, const std::string& json);

// Before the work: throws what requireFileTarget does of the file.
void requireAnswerTarget(const AnswerFlags& flags, const std::string& command);

// Each is asked for where it is needed. `json`, an object, says first which command wrote it.
void answer(const AnswerFlags& flags, const std::string& command, Console& console,
            const std::function<std::string()>& words, const std::function<std::string()>& json);

}  // namespace beam
