// SPDX-License-Identifier: Apache-2.0
// project.json: the small part of a project that people change. Replaced atomically; the last twenty are
// kept.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fields.h"
#include "core/base/hash.h"
#include "core/scene/capture.h"

namespace beam {

// A file or folder of the user: relative to the project folder when it can be, so that both may move
// together.
struct FileReference {
  std::string relative, absolute;  // `relative` may be empty
};
FileReference referenceTo(const std::filesystem::path& target, const std::filesystem::path& project);
// The first of the two that exists; empty when neither does.
std::optional<std::filesystem::path> resolve(const FileReference& reference,
                                             const std::filesystem::path& project);

struct DescriptionFile {  // dataset.json and the like, to know the capture again
  std::string name;
  std::uint64_t bytes = 0;
  Digest digest;
  bool operator==(const DescriptionFile&) const = default;
};
std::vector<DescriptionFile> describeCapture(const std::filesystem::path& capture);

struct ProjectDocument {
  std::string id;  // 32 hexadecimal digits, made at creation; copies and moves keep it
  FileReference capture;
  std::vector<DescriptionFile> capture_files;
  std::optional<FileReference> environment;  // absent: the capture's own
  std::vector<std::string> hold_out;         // camera names, or one number N: every Nth
  std::optional<UpAxis> up;
  std::string preset = "standard";
  std::map<std::string, FieldValue> settings;  // what differs from the preset
  std::string unknown = "{}";                  // members of a later version, kept as they are (JSON)
};

// "+Y", "+Z", "-Y"; parseUpAxis throws Error{Usage}.
std::string toText(UpAxis up);
UpAxis parseUpAxis(std::string_view text);

std::string toJson(const ProjectDocument& document);
// Throws Error{Data} naming `where`; refuses a newer major format and says which program is needed.
ProjectDocument parseProjectDocument(std::string_view json, std::string_view where);

// Writes project.json of the folder and a copy into history/, keeping the last twenty. Takes LOCK for the
// moment: Error{Locked} names its holder when it stays taken.
void writeProjectDocument(const std::filesystem::path& project, const ProjectDocument& document);

}  // namespace beam
