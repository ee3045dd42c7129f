// SPDX-License-Identifier: Apache-2.0
// project.json: the small part of a project that people change. Replaced atomically; the last twenty are
// kept.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/fields.h"
#include "core/base/file_reference.h"
#include "core/base/hash.h"
#include "core/pipeline/file_lock.h"
#include "core/pipeline/takes.h"
#include "core/scene/capture_placement.h"
#include "core/scene/look.h"

namespace beam {

struct DescriptionFile {  // dataset.json and the like, to know the capture again
  std::string name;
  std::uint64_t bytes = 0;
  Digest digest;
  bool operator==(const DescriptionFile&) const = default;
};
std::vector<DescriptionFile> describeCapture(const std::filesystem::path& capture);
// "dataset.json: expected 812 bytes, found 900"; empty: the same, or `expected` says nothing.
std::string differenceOf(const std::vector<DescriptionFile>& expected,
                         const std::vector<DescriptionFile>& found);

struct ProjectDocument {
  std::string id;  // 32 hexadecimal digits, made at creation; copies and moves keep it
  FileReference capture;
  std::vector<DescriptionFile> capture_files;
  std::optional<FileReference> environment;  // absent: the capture's own
  std::vector<std::string> hold_out;         // camera names, or one number N: every Nth
  std::optional<UpAxis> up;
  std::optional<CapturePlacement> world;  // as found when the project was made; absent: only turned
  std::string world_unknown = "{}";       // further members of it, kept as they are (JSON)
  std::string preset = "standard";
  std::map<std::string, FieldValue> settings;  // what differs from the preset
  std::vector<SavedTake> takes;                // later ones win
  // Takes that lost frames to others which have less of them so far; the newest last. No frame is solved in
  // them, and what is looked at comes from them until the others are as far.
  std::vector<SavedTake> earlier_takes;
  std::vector<Look> looks;     // names differ; in no key
  std::string unknown = "{}";  // members of a later version, kept as they are (JSON)
};

// As toText writes it; throws Error{Usage}.
UpAxis parseUpAxis(std::string_view text);

// Its text is not what it should be; of a text of a newer program, which is not broken, a plain Error.
class BrokenDocument : public Error {
 public:
  explicit BrokenDocument(const std::string& message) : Error(Kind::Data, message) {}
};

std::string toJson(const ProjectDocument& document);
// Throws BrokenDocument that names `where` and the place in it; refuses a newer major format and says which
// program is needed.
ProjectDocument parseProjectDocument(std::string_view json, std::string_view where);

// For what looks have no part in: keys, states, history.
ProjectDocument withoutLooks(ProjectDocument document);

std::string newProjectId();

// Whether a file of history/ is a version of ours, by its name: a number. The folder may hold others' files.
bool isHistoryFile(const std::filesystem::path& file);

// For the moment of a change of project.json. Throws Error{Locked} that names the holder when it stays taken,
// and what requireSharedLocks does.
FileLock lockProject(const std::filesystem::path& project);

// Throws Error{Usage} for a name of a file or camera that is no UTF-8: JSON would lose its bytes.
void requireSavable(const std::filesystem::path& project, const ProjectDocument& document);

// What project.json says; none: it is not there, or damaged and to be replaced.
std::optional<ProjectDocument> savedDocument(const std::filesystem::path& project);
// Makes project.json of the folder say what `document` says, with a copy in history/, which keeps the last
// twenty; none where looks are all that differs, for they change with every touch of a light. What another
// program changed there since `base` was read stays and goes into `document` (merged); what both changed is
// warned of and ours holds. Without `base` all is written. Takes are another matter: processes change them
// while others work, so those on disk hold in any case. Takes LOCK for the moment: Error{Locked} names its
// holder when it stays taken.
void writeProjectDocument(const std::filesystem::path& project, ProjectDocument& document,
                          const ProjectDocument* base = nullptr);
// ProjectDocument's.
struct SavedTakes {
  std::vector<SavedTake> now, earlier;
  bool operator==(const SavedTakes&) const = default;
};
SavedTakes takesOf(const ProjectDocument& document);
void setTakes(ProjectDocument& document, SavedTakes takes);
// Changes the takes in project.json and nothing else of it, whatever another process wrote there meanwhile;
// gives them as they are now. Writes only when they differ. Throws like writeProjectDocument.
using ChangeTakes = std::function<SavedTakes(const SavedTakes&)>;
SavedTakes changeSavedTakes(const std::filesystem::path& project, const ChangeTakes& change);

}  // namespace beam
