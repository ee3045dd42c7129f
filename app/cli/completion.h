// SPDX-License-Identifier: Apache-2.0
// Completion scripts for shells, made of the declarations of the commands: a new command or flag joins by
// itself.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace beam {

std::vector<std::string> completedShells();  // "bash", "zsh"
// Throws Error{Usage} for another shell.
std::string completionScript(const CLI::App& app, const std::string& shell);

}  // namespace beam
