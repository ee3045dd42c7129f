// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {
namespace {

struct flock wholeFile(short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}

std::string ownHost() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return host.data();
}

void writeHolder(int descriptor) {
  const std::string text = fmt::format("host {}, process {}\n", ownHost(), ::getpid());
  // Only for messages; a lock without a note is still a lock.
  if (::ftruncate(descriptor, 0) == 0 && ::pwrite(descriptor, text.data(), text.size(), 0) < 0) errno = 0;
}

// Whether `path` still names the file behind the descriptor: its last holder may just have removed it.
bool stillNamed(int descriptor, const std::filesystem::path& path) {
  struct stat here {
  }, there{};
  return ::fstat(descriptor, &here) == 0 && ::stat(path.c_str(), &there) == 0 &&
         here.st_ino == there.st_ino && here.st_dev == there.st_dev;
}

}  // namespace

std::optional<FileLock> FileLock::tryAcquire(const std::filesystem::path& path) {
  for (;;) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (descriptor < 0) {
      throw Error(Error::Kind::Storage,
                  fmt::format("cannot make the lock \"{}\": {}", path.string(), std::strerror(errno)));
    }
    FileLock lock(descriptor, path);
    struct flock wanted = wholeFile(F_WRLCK);
    if (::fcntl(descriptor, F_OFD_SETLK, &wanted) != 0) {
      if (errno == EAGAIN || errno == EACCES) return std::nullopt;
      throw Error(Error::Kind::Storage,
                  fmt::format("cannot lock \"{}\": {}; locks must work on the project's file system",
                              path.string(), std::strerror(errno)));
    }
    if (!stillNamed(descriptor, path)) continue;
    writeHolder(descriptor);
    return lock;
  }
}

bool FileLock::isHeld(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) {
    if (const Error why = openError(path, errno); why.kind() != Error::Kind::Data) throw why;
    return false;
  }
  struct flock question = wholeFile(F_WRLCK);
  const bool answered = ::fcntl(descriptor, F_OFD_GETLK, &question) == 0;
  const int why = errno;
  ::close(descriptor);
  if (!answered) {
    throw Error(
        Error::Kind::Storage,
        fmt::format("cannot look at the lock \"{}\": {}; locks must work on the project's file system",
                    path.string(), std::strerror(why)));
  }
  return question.l_type != F_UNLCK;
}

std::string FileLock::holderOf(const std::filesystem::path& path) {
  try {
    std::string text = readTextFile(path, 4096);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.empty() ? "unknown" : text;
  } catch (const Error&) {
    return "unknown";
  }
}

std::string FileLock::shortHolderOf(const std::filesystem::path& path) {
  const std::string whole = holderOf(path);
  const std::size_t comma = whole.rfind(", process ");
  if (!whole.starts_with("host ") || comma == std::string::npos) return {};
  const std::string host = whole.substr(5, comma - 5), process = whole.substr(comma + 2);
  return process + (host == ownHost() ? " on this machine" : " on host " + host);
}

FileLock::FileLock(FileLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      path_(std::move(other.path_)),
      remove_(other.remove_) {}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  if (remove_) ::unlink(path_.c_str());
  ::close(descriptor_);
}

}  // namespace beam
