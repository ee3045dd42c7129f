// SPDX-License-Identifier: Apache-2.0
#include "core/io/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <utility>

#include "core/base/error.h"

namespace beam {
namespace {

constexpr std::size_t kPiece = 4u << 20;
constexpr std::size_t kUnsynced = 32u << 20;  // a slow disk takes less than half a second for it

Error::Kind kindOf(int error_number) {
  return error_number == ENOMEM ? Error::Kind::OutOfMemory : Error::Kind::Storage;
}

[[noreturn]] void storageError(std::string_view doing, const std::filesystem::path& path) {
  const int reason = errno;
  throw Error(kindOf(reason),
              fmt::format("cannot {} \"{}\": {}", doing, path.string(), std::strerror(reason)));
}

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

std::uint64_t regularFileSize(int fd, const std::filesystem::path& path, std::uint64_t max_bytes) {
  struct stat info {};
  if (::fstat(fd, &info) != 0) storageError("examine", path);
  if (!S_ISREG(info.st_mode)) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": expected a regular file", path.string()));
  }
  const auto size = static_cast<std::uint64_t>(info.st_size);
  if (size > max_bytes) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": expected at most {} bytes, found {}", path.string(), max_bytes, size));
  }
  return size;
}

template <class Buffer>
Buffer readWhole(const std::filesystem::path& path, std::uint64_t max_bytes) {
  // O_NONBLOCK: a pipe in the place of a file is refused, not waited for.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) throw openError(path, errno);
  Buffer bytes(regularFileSize(file.get(), path, max_bytes), {});
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(file.get(), bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EISDIR) throw openError(path, errno);
    if (n < 0) throw readError(path, errno);
    if (n == 0) {
      throw Error(Error::Kind::Data,
                  fmt::format("\"{}\" shrank while it was read: expected {} bytes, found {}", path.string(),
                              bytes.size(), done));
    }
    done += static_cast<std::size_t>(n);
  }
  return bytes;
}

void writeAll(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), std::min(bytes.size(), kPiece));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) storageError("write", path);
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
}

std::atomic<unsigned> temporary_files{0};

std::filesystem::path folderOf(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

// A new file beside `path`, open; its name goes into `temporary`. A killed process of our number, which in
// containers comes again and again, may have left some of these names.
int createBeside(const std::filesystem::path& path, std::filesystem::path& temporary) {
  for (int left_over = 0; left_over < 10000; ++left_over) {
    temporary = folderOf(path) /
                fmt::format(".{}.{}.{}.tmp", path.filename().string(), ::getpid(), temporary_files++);
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (file >= 0) return file;
    if (errno != EEXIST) break;
  }
  storageError("create a file beside", path);
}

}  // namespace

Error openError(const std::filesystem::path& path, int error_number) {
  return {lastsUntilChanged(error_number) ? Error::Kind::Data : kindOf(error_number),
          fmt::format("cannot open \"{}\": {}", path.string(), std::strerror(error_number))};
}

std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t max_bytes) {
  return readWhole<std::vector<std::byte>>(path, max_bytes);
}

std::string readTextFile(const std::filesystem::path& path, std::uint64_t max_bytes) {
  return readWhole<std::string>(path, max_bytes);
}

void syncPath(const std::filesystem::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) storageError("open", path);
  // EINVAL: the file system has no sync for folders; the promise is then weaker, the data is not.
  if (::fsync(file.get()) != 0 && errno != EINVAL) storageError("sync", path);
}

UnpublishedFile::UnpublishedFile(std::filesystem::path path)
    : path_(std::move(path)), descriptor_(createBeside(path_, name_)) {}

UnpublishedFile::~UnpublishedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!name_.empty()) ::unlink(name_.c_str());
}

void UnpublishedFile::publish() {
  if (::fsync(descriptor_) != 0) storageError("sync", path_);
  if (::close(std::exchange(descriptor_, -1)) != 0) storageError("close", path_);
  if (::rename(name_.c_str(), path_.c_str()) != 0) storageError("rename into", path_);
  name_.clear();
  syncPath(folderOf(path_));
}

void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  UnpublishedFile file(path);
  writeAll(file.descriptor(), bytes, path);
  file.publish();
}

void writeFileAtomically(const std::filesystem::path& path, std::string_view text) {
  writeFileAtomically(path, std::as_bytes(std::span(text.data(), text.size())));
}

void writeFileAtomically(const std::filesystem::path& path, const std::function<std::string_view()>& next) {
  UnpublishedFile file(path);
  std::size_t unsynced = 0;
  for (std::string_view piece = next(); !piece.empty(); piece = next()) {
    writeAll(file.descriptor(), std::as_bytes(std::span(piece.data(), piece.size())), path);
    unsynced += piece.size();
    if (unsynced < kUnsynced) continue;
    if (::fdatasync(file.descriptor()) != 0) storageError("sync", path);
    unsynced = 0;
  }
  file.publish();
}

Error readError(const std::filesystem::path& path, int error_number) {
  return {kindOf(error_number),
          fmt::format("cannot read \"{}\": {}; try again, and where it stays so copy the file anew",
                      path.string(), std::strerror(error_number))};
}

std::vector<std::filesystem::directory_entry> entriesOf(const std::filesystem::path& folder) {
  std::vector<std::filesystem::directory_entry> found;
  std::error_code failed;
  // One that failed is at its end.
  for (std::filesystem::directory_iterator i(folder, failed), end; !failed && i != end; i.increment(failed))
    found.push_back(*i);
  if (failed && !lastsUntilChanged(failed.value())) {
    errno = failed.value();
    storageError("list", folder);
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::filesystem::directory_entry> entriesBelow(const std::filesystem::path& folder) {
  std::vector<std::filesystem::directory_entry> found;
  for (const std::filesystem::directory_entry& entry : entriesOf(folder)) {
    found.push_back(entry);
    std::error_code gone;
    if (entry.symlink_status(gone).type() != std::filesystem::file_type::directory) continue;
    const std::vector<std::filesystem::directory_entry> below = entriesBelow(entry.path());
    found.insert(found.end(), below.begin(), below.end());
  }
  return found;
}

Error storageError(const std::filesystem::filesystem_error& refused) {
  if (refused.code() == std::errc::not_enough_memory) {
    return {Error::Kind::OutOfMemory,
            fmt::format("{}; close other programs, or ask for less at once", refused.what())};
  }
  return {Error::Kind::Storage,
          fmt::format("{}; expected a place that can be read and written, with room left", refused.what())};
}

}  // namespace beam
