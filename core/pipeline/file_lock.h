// SPDX-License-Identifier: Apache-2.0
// Locks of the kernel on files of the project: freed by the kernel however the process ends, so none is ever
// stale.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace beam {

// An exclusive open-file-description lock, held while the object lives. (flock cannot be looked at without
// being taken; this kind can.)
class FileLock {
 public:
  // Empty when somebody else, in this process or another, holds it. Creates the file and writes who holds it
  // into it. Throws Error{Storage} when the file cannot be made.
  static std::optional<FileLock> tryAcquire(const std::filesystem::path& path);
  // Whether somebody holds it. Writes nothing. Throws Error{Storage} where that cannot be told.
  static bool isHeld(const std::filesystem::path& path);
  // "host h, process 123", as the holder wrote; for messages.
  static std::string holderOf(const std::filesystem::path& path);
  // "process 123", of another machine "process 123 on host h"; empty when nobody wrote so.
  static std::string shortHolderOf(const std::filesystem::path& path);

  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();  // unlocks; removes the file first when asked to
  void removeFileAtRelease() { remove_ = true; }

 private:
  FileLock(int descriptor, std::filesystem::path path) : descriptor_(descriptor), path_(std::move(path)) {}
  int descriptor_ = -1;
  std::filesystem::path path_;
  bool remove_ = false;
};

}  // namespace beam
