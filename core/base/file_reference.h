// SPDX-License-Identifier: Apache-2.0
// A file or folder of the user, named by a document of ours: relative to the document's folder when it can
// be, so that both may move together, and absolute, so that the document may move alone.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace beam {

// Whether the refusal of a file, by errno, lasts until somebody changes the file or the folders above it;
// else it may be otherwise a moment later.
bool lastsUntilChanged(int error_number);

// Whether there is a file or folder of that name, as far as it can be reached. Throws Error{Storage} where
// the disk does not tell: that is neither.
bool isThere(const std::filesystem::path& path);

// Whether `inner` is `outer` or lies below it, by their names alone.
bool isAtOrBelow(const std::filesystem::path& inner, const std::filesystem::path& outer);

struct FileReference {
  std::string relative, absolute;  // '/' between their parts; `relative` may be empty
  bool empty() const { return relative.empty() && absolute.empty(); }
  bool operator==(const FileReference&) const = default;
};
// `folder`: the project's, or that of the file which holds the reference.
FileReference referenceTo(const std::filesystem::path& target, const std::filesystem::path& folder);
// The first of the two that exists; empty when neither does.
std::optional<std::filesystem::path> resolve(const FileReference& reference,
                                             const std::filesystem::path& folder);

}  // namespace beam
