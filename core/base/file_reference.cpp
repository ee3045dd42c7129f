// SPDX-License-Identifier: Apache-2.0
#include "core/base/file_reference.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

#include "core/base/error.h"

namespace beam {
namespace fs = std::filesystem;

bool lastsUntilChanged(int error_number) {
  static constexpr int kLasting[] = {ENOENT, ENOTDIR, ELOOP,  ENAMETOOLONG, EACCES,
                                     EPERM,  ENXIO,   EISDIR, EINVAL};
  return std::find(std::begin(kLasting), std::end(kLasting), error_number) != std::end(kLasting);
}

bool isAtOrBelow(const std::filesystem::path& inner, const std::filesystem::path& outer) {
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

bool isThere(const fs::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0) return true;
  if (lastsUntilChanged(errno)) return false;
  throw Error(Error::Kind::Storage,
              fmt::format("cannot examine \"{}\": {}", path.string(), std::strerror(errno)));
}

FileReference referenceTo(const fs::path& target, const fs::path& folder) {
  std::error_code failed;
  const fs::path absolute = fs::weakly_canonical(fs::absolute(target), failed);
  const fs::path base = fs::weakly_canonical(fs::absolute(folder), failed);
  return {absolute.lexically_relative(base).generic_string(), absolute.generic_string()};
}

std::optional<fs::path> resolve(const FileReference& reference, const fs::path& folder) {
  std::error_code failed;
  if (!reference.relative.empty()) {
    const fs::path base = fs::weakly_canonical(fs::absolute(folder), failed);
    const fs::path beside = (base / reference.relative).lexically_normal();
    if (isThere(beside)) return beside;
  }
  if (!reference.absolute.empty() && isThere(reference.absolute)) return fs::path(reference.absolute);
  return std::nullopt;
}

}  // namespace beam
