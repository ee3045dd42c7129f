// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/session_log.h"

#include <fmt/chrono.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/file.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kKept = 20;

const char* nameOf(LogLevel level) {
  switch (level) {
    case LogLevel::Debug:
      return "debug";
    case LogLevel::Info:
      return "info";
    case LogLevel::Warning:
      return "warning";
    case LogLevel::Error:
      return "error";
  }
  return "";
}

void dropOldest(const fs::path& folder) {
  std::vector<fs::path> files;
  try {
    for (const fs::directory_entry& entry : entriesOf(folder)) files.push_back(entry.path());
  } catch (const Error&) {  // no run fails for its log
    return;
  }
  std::error_code failed;
  for (std::size_t i = 0; i + kKept <= files.size(); ++i) fs::remove(files[i], failed);
}

}  // namespace

SessionLog::SessionLog(const fs::path& project) {
  const fs::path folder = project / "logs";
  std::error_code failed;
  fs::create_directories(folder, failed);
  dropOldest(folder);
  const std::string name =
      fmt::format("{:%Y%m%dT%H%M%SZ}-{}.log", fmt::gmtime(std::time(nullptr)), ::getpid());
  file_ = std::fopen((folder / name).c_str(), "ae");
  if (!file_) return;
  sink_ = addLogSink([this](const LogRecord& record) {
    const std::string line = fmt::format("{:%H:%M:%S} {}: {}\n", fmt::gmtime(std::time(nullptr)),
                                         nameOf(record.level), record.text);
    std::fputs(line.c_str(), file_);
    std::fflush(file_);
  });
}

SessionLog::~SessionLog() {
  if (!file_) return;
  removeLogSink(sink_);
  std::fclose(file_);
}

}  // namespace beam
