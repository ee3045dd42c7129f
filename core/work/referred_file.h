// SPDX-License-Identifier: Apache-2.0
// What a look or a scene refers to, where it has to be there.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "core/base/error.h"
#include "core/base/file_reference.h"

namespace beam {

// References are relative to `folder`. Throws Error{Data} where it is gone: "<what> is gone: expected it at
// "..."; put it back, or <else_do>".
inline std::filesystem::path referredFile(const FileReference& reference, const std::filesystem::path& folder,
                                          std::string_view what, std::string_view else_do) {
  if (const auto file = resolve(reference, folder)) return *file;
  throw Error(
      Error::Kind::Data,
      fmt::format("{} is gone: expected it at \"{}\"; put it back, or {}", what,
                  reference.absolute.empty() ? (folder / reference.relative).string() : reference.absolute,
                  else_do));
}

}  // namespace beam
