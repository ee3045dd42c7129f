// SPDX-License-Identifier: Apache-2.0
#include "core/base/file_reference.h"

namespace beam {
namespace fs = std::filesystem;

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
    if (fs::exists(beside, failed)) return beside;
  }
  if (!reference.absolute.empty() && fs::exists(reference.absolute, failed))
    return fs::path(reference.absolute);
  return std::nullopt;
}

}  // namespace beam
