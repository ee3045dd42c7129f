// SPDX-License-Identifier: Apache-2.0
// What a path that was given in place of another kind of thing is, for the error that says so.
#pragma once

#include <filesystem>
#include <string>

namespace beam {

// "is not there"; "is a project: see beam status \"X\""; "is a capture: make a project of it with beam
// process
// \"X\" --out Name.beam"; of a file and of any other folder what is known of it.
std::string kindInWords(const std::filesystem::path& path);

// Throws Error{Data} that says what it is instead where it is neither a folder nor a panorama nor splats, or
// a project.
void requireCheckable(const std::filesystem::path& path);

// Throws Error{Data} that says what it is instead where it is no folder, or a project.
void requireCaptureFolder(const std::filesystem::path& path);

}  // namespace beam
