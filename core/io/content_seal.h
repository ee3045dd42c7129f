// SPDX-License-Identifier: Apache-2.0
// A picture or mesh that says the digest of its own bytes, as a note, taken with '0' in
// place of each digit (and of each byte of PNG's checksum of the note): what was cut, damaged or written anew
// by another program is known by it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "core/base/hash.h"
#include "core/io/written_by.h"

namespace beam {

inline constexpr const char* kContentNote = "content";

// `notes` with a note of zeros for seal() at their end; none of none: a file without notes says nothing.
FileNotes sealable(FileNotes notes);
FileNotes sealed(FileNotes sealable_notes, const Digest& of_the_bytes);

// Writes the digest into a whole PNG or EXR file with sealable notes; leaves one without as it is.
void seal(std::span<std::byte> file);

// Whether the file is a PNG, EXR or PLY file that holds the digest of its bytes. Reads all of them.
bool isSealed(const std::filesystem::path& file);

}  // namespace beam
