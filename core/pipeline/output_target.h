// SPDX-License-Identifier: Apache-2.0
// Where a command may write: never into a capture, into a project only by the project's own commands, and
// over a file only what the same command wrote. Asked before the work, so that hours do not end in a refusal.
#pragma once

#include <filesystem>
#include <set>
#include <span>
#include <string>

namespace beam {

class Project;

struct OutputRule {
  std::string command;  // as typed after "beam": "render"; files say it (io/written_by.h)
  bool force = false;   // files of others are replaced as well
  // Folders that nothing is written into: of photographs that a capture names outside of its own folder.
  std::set<std::filesystem::path> inputs = {};
};

// Throws Error{Usage} when `place`, which need not be there, is or lies in a capture or a project, or is
// empty.
void requireOutside(const std::filesystem::path& place);

// Where the photographs and masks of a project's capture lie, links followed.
std::set<std::filesystem::path> inputFolders(const Project& project);

// For a file that will be written. Makes its folder. Throws Error{Usage}: inside a capture or a project, no
// name of a file ("out/"), no regular file, or one that another wrote; Error{Storage}: the folder cannot be
// made or written into.
void requireFileTarget(const std::filesystem::path& file, const OutputRule& rule);

// For a folder that `files`, named in it, will be written into. Makes it and looks at each of the files as
// requireFileTarget does.
void requireFolderTarget(const std::filesystem::path& folder, std::span<const std::filesystem::path> files,
                         const OutputRule& rule);

}  // namespace beam
