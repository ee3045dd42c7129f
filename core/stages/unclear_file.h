// SPDX-License-Identifier: Apache-2.0
// A file of a finished result that is whole and yet makes no sense: another program wrote it, or this one
// wrongly.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "core/base/error.h"

namespace beam {

// `file` lies in the result's folder.
inline Error unclearFile(const std::filesystem::path& file, std::string_view why) {
  return Error(Error::Kind::Data,
               fmt::format("\"{}\" cannot be understood: {}; delete the folder \"{}\" and run again",
                           file.string(), why, file.parent_path().string()));
}

}  // namespace beam
