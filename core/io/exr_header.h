// SPDX-License-Identifier: Apache-2.0
// Our own look at an OpenEXR header, before the library sees a byte: sizes against the bytes that are there
// and an allow-list of features, for a broken or hostile file must not take memory or run old decoders.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace beam {

// Throws Error{Data} that names the file and what it holds: empty, no EXR, multi-part, deep, mip-mapped, a
// compression other than NONE, RLE, ZIPS, ZIP and PIZ, or sizes that the bytes cannot hold.
void checkExrHeader(std::span<const std::byte> bytes, const std::filesystem::path& path);

}  // namespace beam
