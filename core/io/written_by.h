// SPDX-License-Identifier: Apache-2.0
// What a file says of the command that wrote it, so that a command replaces its own files and nobody else's.
// It stands near the beginning of a file: a text chunk of PNG, an attribute of EXR, a comment of PLY, a meta
// element of HTML, a member of JSON; in the comment of an MP4, wherever that is.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace beam {

// "BEAM Studio, beam render" of "render".
std::string writerOf(std::string_view command);

// Whether the beginning of `file` says so in the way of its format: that a text speaks of the program is not
// enough. False also for what cannot be read.
bool isWrittenBy(const std::filesystem::path& file, std::string_view command);

// What a file says of itself beside its data: a name of ASCII letters and '_', and a text, each.
using FileNotes = std::vector<std::pair<std::string, std::string>>;
// The text of that name; empty: there is none.
std::string noteIn(const FileNotes& notes, std::string_view name);

}  // namespace beam
