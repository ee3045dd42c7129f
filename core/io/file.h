// SPDX-License-Identifier: Apache-2.0
// Files: bounded reading, and the only ways in which bytes are written (write, fsync, rename, fsync of the
// folder).
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/file_reference.h"

namespace beam {

// Why opening `path` was refused: Error{Data} for what stays so until somebody changes the file (missing, not
// permitted), Error{Storage} for what may be otherwise a moment later.
Error openError(const std::filesystem::path& path, int error_number);

// Error{Storage}: reading failed in the middle of the file.
Error readError(const std::filesystem::path& path, int error_number);

// The whole file. Throws openError, Error{Data} when it is no regular file or larger than `max_bytes`,
// Error{Storage} when reading fails.
std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t max_bytes);
inline constexpr std::uint64_t kMostTextBytes = 64u << 20;
std::string readTextFile(const std::filesystem::path& path, std::uint64_t max_bytes = kMostTextBytes);

// Creates or replaces `path`: a temporary file in the same folder, fsync, rename, fsync of the folder. Throws
// Error{Storage} with the reason (disk full, read-only folder) and leaves nothing behind.
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void writeFileAtomically(const std::filesystem::path& path, std::string_view text);
// Piece after piece, an empty one at the end. `next` may throw, which leaves nothing behind either; so that
// it is soon asked again, what there is goes to the disk as it comes.
void writeFileAtomically(const std::filesystem::path& path, const std::function<std::string_view()>& next);

// A file that another program or library writes by name: it lies empty in the folder of `path`, under a name
// of its own, until publish() puts it there as writeFileAtomically does, and is gone where that is not
// called.
class UnpublishedFile {
 public:
  // Throws Error{Storage} where nothing can be written beside `path`.
  explicit UnpublishedFile(std::filesystem::path path);
  ~UnpublishedFile();
  UnpublishedFile(const UnpublishedFile&) = delete;
  UnpublishedFile& operator=(const UnpublishedFile&) = delete;

  const std::filesystem::path& name() const { return name_; }
  int descriptor() const { return descriptor_; }  // open for writing
  // Once, when all is written: fsync, rename, fsync of the folder. Throws Error{Storage}.
  void publish();

 private:
  std::filesystem::path path_, name_;
  int descriptor_ = -1;
};

// Syncs a file or folder that was written otherwise; Error{Storage} on failure.
void syncPath(const std::filesystem::path& path);

// What a folder holds, in order of name; nothing of one that is not there or may not be read. Throws
// Error{Storage} where the disk does not tell: half a list would be taken for the whole.
std::vector<std::filesystem::directory_entry> entriesOf(const std::filesystem::path& folder);
// Likewise, each folder followed by all that lies in it; links are not followed.
std::vector<std::filesystem::directory_entry> entriesBelow(const std::filesystem::path& folder);

// What std::filesystem refused between our own checks, for the borders where it arrives: Error{Storage}, or
// Error{OutOfMemory} where it had no room.
Error storageError(const std::filesystem::filesystem_error& refused);

}  // namespace beam
