// SPDX-License-Identifier: Apache-2.0
// What a picture or mesh says of itself, read back without decoding it.
#pragma once

#include <filesystem>

#include "core/io/written_by.h"

namespace beam {

// The notes of a PNG (tEXt), EXR (string attributes) or PLY file (comments) of ours whose bytes are those
// that were written (content_seal.h). Empty for anything else: no such file, a changed one, one without
// notes.
FileNotes notesIn(const std::filesystem::path& file);

}  // namespace beam
