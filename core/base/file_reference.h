// SPDX-License-Identifier: Apache-2.0
// A file or folder of the user, named by a document of ours: relative to the document's folder when it can
// be, so that both may move together, and absolute, so that the document may move alone.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace beam {

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
