// SPDX-License-Identifier: Apache-2.0
// What a picture or mesh says of itself, read back without decoding it.
#pragma once

#include <filesystem>

#include "core/io/written_by.h"

namespace beam {

// The notes of a PNG picture (tEXt, checksums of all chunks compared), an EXR picture (string attributes) or
// a PLY file (comments, of a table whose lists are triangles) that is whole: its end is where its header
// says. Empty for anything else: no such file, half a one, another format, one without notes.
FileNotes notesIn(const std::filesystem::path& file);

}  // namespace beam
