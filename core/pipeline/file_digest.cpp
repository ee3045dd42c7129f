// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/file_digest.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <vector>

#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {

Digest digestOfFile(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw openError(path, errno);
  Hasher hasher;
  std::vector<std::byte> piece(1u << 20);
  for (;;) {
    const ssize_t n = ::read(descriptor, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int why = errno;
      ::close(descriptor);
      if (why == EISDIR) throw openError(path, why);
      throw readError(path, why);
    }
    if (n == 0) break;
    hasher.add(std::span(piece.data(), static_cast<std::size_t>(n)));
  }
  ::close(descriptor);
  return hasher.digest();
}

std::string fileStamp(const std::filesystem::path& path) {
  struct stat s {};
  if (::stat(path.c_str(), &s) != 0 || !S_ISREG(s.st_mode)) return {};
  return fmt::format("{}:{}.{}:{}.{}:{}:{}", s.st_size, s.st_mtim.tv_sec, s.st_mtim.tv_nsec, s.st_ctim.tv_sec,
                     s.st_ctim.tv_nsec, s.st_ino, s.st_dev);
}

bool justChanged(const std::filesystem::path& path) {
  struct stat s {};
  return ::stat(path.c_str(), &s) == 0 && std::time(nullptr) - s.st_ctim.tv_sec < 2;
}

}  // namespace beam
