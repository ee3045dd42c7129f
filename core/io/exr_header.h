// SPDX-License-Identifier: Apache-2.0
// Our own look at an OpenEXR header, before the library sees a byte: sizes against the bytes that are there
// and an allow-list of features, for a broken or hostile file must not take memory or run old decoders. What
// would not be read is not written either.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "core/io/written_by.h"

namespace beam {

// Throws Error{Data} that names the file and what it holds: empty, no EXR, multi-part, deep, mip-mapped, a
// compression other than NONE, RLE, ZIPS, ZIP and PIZ, or sizes that the bytes cannot hold.
void checkExrHeader(std::span<const std::byte> bytes, const std::filesystem::path& path);

// The string attributes of the header. Throws Error{Data} as above. Decodes nothing.
FileNotes exrNotes(std::span<const std::byte> bytes, const std::filesystem::path& path);

// Throws Error{Data} that names the limit where a picture of `channels` channels with `pixel_bytes` together
// a pixel would not be read again. Takes no memory.
void requireExrSize(int width, int height, std::size_t channels, std::size_t pixel_bytes,
                    const std::filesystem::path& path);

}  // namespace beam
