// SPDX-License-Identifier: Apache-2.0
// Earlier versions of project.json, for a project whose own is broken or gone.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/pipeline/project_document.h"

namespace beam {

struct HistoryEntry {
  std::filesystem::path file;
  std::chrono::system_clock::time_point file_time;
  bool readable = false;
  std::string summary;  // "preset standard, 3 settings differ"; of one that is not readable, why
};

// What history/ holds, the newest first; empty when there is none.
std::vector<HistoryEntry> projectHistory(const std::filesystem::path& project);

// Makes project.json say what the entry does. What it was stays as project.json.broken-N. Throws Error{Data}
// for an entry that is not readable, Error{Locked} or Error{Storage}.
void restoreProject(const std::filesystem::path& project, const HistoryEntry& entry);

// Whether it is a project or what is left of one: results or a history of ours.
bool looksLikeProject(const std::filesystem::path& folder);

// "history/ has 4 readable versions of it: ..."; what to do about a project.json that cannot be read.
std::string historyAdvice(const std::filesystem::path& project);

// project.json as it is on disk. Throws Error{Data} that says what is broken and what to do.
ProjectDocument readProjectDocument(const std::filesystem::path& project);

}  // namespace beam
