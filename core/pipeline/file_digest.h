// SPDX-License-Identifier: Apache-2.0
// A file's digest, read in pieces, and its stamp: what the file system says of it, which changes when its
// bytes do.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/hash.h"

namespace beam {

// Throws openError (io/file.h), Error{Storage} when reading fails.
Digest digestOfFile(const std::filesystem::path& path);

// Size, times and inode; empty when there is no such regular file. A hint that saves hashing, never the
// truth.
std::string fileStamp(const std::filesystem::path& path);

// Whether the file changed less than two seconds ago: its next change might leave the same stamp.
bool justChanged(const std::filesystem::path& path);

}  // namespace beam
