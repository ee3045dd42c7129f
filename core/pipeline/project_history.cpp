// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/project_history.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kKeyDigits = 32;

std::string summaryOf(const ProjectDocument& document) {
  const std::size_t n = document.settings.size();
  if (n == 0) return fmt::format("preset {}, no setting differs", document.preset);
  return fmt::format("preset {}, {}", document.preset, countText(n, "setting differs", "settings differ"));
}

std::chrono::system_clock::time_point timeOf(const fs::path& file) {
  std::error_code failed;
  const fs::file_time_type time = fs::last_write_time(file, failed);
  if (failed) return {};
  return std::chrono::time_point_cast<std::chrono::system_clock::duration>(
      std::chrono::file_clock::to_sys(time));
}

HistoryEntry entryOf(const fs::path& file) {
  HistoryEntry entry{file, timeOf(file), false, {}};
  try {
    entry.summary = summaryOf(parseProjectDocument(readTextFile(file), file.string()));
    entry.readable = true;
  } catch (const Error& e) {
    requireData(e);
    entry.summary = e.what();
  }
  return entry;
}

std::vector<fs::path> historyFiles(const fs::path& project) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : entriesOf(project / "history"))
    if (isHistoryFile(entry.path())) files.push_back(entry.path());
  std::sort(files.rbegin(), files.rend());  // numbers have eight digits
  return files;
}

// The broken file under a name of its own, before another takes its place.
void keepAside(const fs::path& file) {
  for (int n = 1;; ++n) {
    const fs::path aside = fmt::format("{}.broken-{}", file.string(), n);
    std::error_code failed;
    if (fs::exists(aside, failed)) continue;
    fs::create_hard_link(file, aside, failed);
    if (failed) fs::copy_file(file, aside);  // a file system without links
    return;
  }
}

}  // namespace

std::vector<HistoryEntry> projectHistory(const fs::path& project) {
  std::vector<HistoryEntry> entries;
  for (const fs::path& file : historyFiles(project)) entries.push_back(entryOf(file));
  return entries;
}

void restoreProject(const fs::path& project, const HistoryEntry& entry) {
  const std::string text = readTextFile(entry.file);
  parseProjectDocument(text, entry.file.string());
  const fs::path file = project / "project.json";
  const FileLock lock = lockProject(project);
  try {
    std::error_code failed;
    if (fs::exists(file, failed)) keepAside(file);
  } catch (const fs::filesystem_error& e) {
    throw storageError(e);
  }
  writeFileAtomically(file, text);
}

bool looksLikeProject(const fs::path& folder) {
  std::error_code failed;
  if (fs::is_regular_file(folder / "project.json", failed) || !historyFiles(folder).empty()) return true;
  for (const fs::directory_entry& entry : entriesOf(folder / "results")) {
    const std::string name = entry.path().filename().string();
    if (name.size() == kKeyDigits && name.find_first_not_of("0123456789abcdef") == std::string::npos)
      return true;
  }
  return false;
}

std::string historyAdvice(const fs::path& project) {
  const std::vector<HistoryEntry> entries = projectHistory(project);
  const auto n = std::count_if(entries.begin(), entries.end(), [](const auto& e) { return e.readable; });
  if (n == 0) {
    return "there is no readable version of it in history/: make a new project of the capture, and put its "
           "project.json here to have the results again";
  }
  return fmt::format(
      "history/ has {} of it: restore one in the studio, or copy it over "
      "\"{}\"",
      countText(n, "readable version"), (project / "project.json").string());
}

ProjectDocument readProjectDocument(const fs::path& project) {
  const fs::path file = project / "project.json";
  const std::string text = readTextFile(file);
  try {
    return parseProjectDocument(text, file.string());
  } catch (const BrokenDocument& e) {
    throw Error(e.kind(), fmt::format("{}; {}", e.what(), historyAdvice(project)));
  }
}

}  // namespace beam
