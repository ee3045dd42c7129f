// SPDX-License-Identifier: Apache-2.0
// The help of a command, made of its declaration and its examples.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace beam {

std::string helpText(const CLI::App& command);
// Everything that help says, for other programs; of some commands and topics alone, where `words` names them.
std::string helpJson(const CLI::App& app, const std::vector<std::string>& words);
// Every command and topic as one Markdown page: resources/command-line.md.
std::string helpMarkdown(const CLI::App& app);

}  // namespace beam
