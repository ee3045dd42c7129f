// SPDX-License-Identifier: Apache-2.0
// One log file a run under logs/ of a project; the newest twenty are kept.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>

namespace beam {

class SessionLog {
 public:
  // A log that cannot be opened is silently none: it must not stop a run.
  explicit SessionLog(const std::filesystem::path& project);
  ~SessionLog();
  SessionLog(const SessionLog&) = delete;
  SessionLog& operator=(const SessionLog&) = delete;

 private:
  std::FILE* file_ = nullptr;
  int sink_ = 0;
};

}  // namespace beam
