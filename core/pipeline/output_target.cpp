// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/output_target.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <set>

#include "core/base/error.h"
#include "core/io/capture_pictures.h"
#include "core/io/capture_reader.h"
#include "core/io/written_by.h"
#include "core/pipeline/project.h"
#include "core/pipeline/project_history.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

// Links and ".." followed as far as the path is there.
fs::path resolved(const fs::path& place) {
  std::error_code failed;
  const fs::path absolute = fs::absolute(place, failed);
  const fs::path real = fs::weakly_canonical(failed ? place : absolute, failed);
  return failed ? place.lexically_normal() : real;
}

[[noreturn]] void liesIn(const fs::path& place, const fs::path& owner, const char* what) {
  if (resolved(place) == owner) {
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" exists and is a {}, which is never written over; choose another name",
                            place.string(), what));
  }
  throw Error(Error::Kind::Usage,
              fmt::format("\"{}\" lies in the {} \"{}\", which is never written into; choose a place outside",
                          place.string(), what, owner.string()));
}

enum class Making { Now, Later };

// What is there of `folder` can be gone into and written into.
void requireFolder(const fs::path& folder, Making making = Making::Now) {
  std::error_code failed;
  fs::path there = folder;
  if (making == Making::Now) fs::create_directories(folder, failed);
  while (making == Making::Later && there.has_parent_path() && !fs::exists(fs::symlink_status(there, failed)))
    there = there.parent_path();
  if (!fs::is_directory(there, failed)) {
    throw Error(Error::Kind::Storage,
                fmt::format("\"{}\" cannot be made: \"{}\" is no folder", folder.string(), there.string()));
  }
  if (::access(there.c_str(), W_OK | X_OK) != 0) {
    throw Error(Error::Kind::Storage,
                fmt::format("cannot write into \"{}\": {}", there.string(), std::strerror(errno)));
  }
}

void requireOwn(const fs::path& file, const OutputRule& rule) {
  std::error_code failed;
  const fs::file_status there = fs::status(file, failed);
  const bool dangling = !fs::exists(there) && fs::is_symlink(fs::symlink_status(file, failed));
  if (!fs::exists(there) && !dangling) return;
  if (!dangling && !fs::is_regular_file(there)) {
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" is a folder or a device; expected the name of a file", file.string()));
  }
  if (rule.force) return;
  if (!dangling && (fs::file_size(file, failed) == 0 || isWrittenBy(file, rule.command))) return;
  throw Error(
      Error::Kind::Usage,
      fmt::format(
          "\"{}\" is there and was not written by beam {}; choose another name, or replace it with --force",
          file.string(), rule.command));
}

void requireNoInput(const fs::path& folder, const OutputRule& rule) {
  if (!rule.inputs.contains(resolved(folder))) return;
  throw Error(
      Error::Kind::Usage,
      fmt::format(
          "\"{}\" holds photographs of the capture, which are never written over; choose another place",
          folder.string()));
}

}  // namespace

std::set<fs::path> inputFolders(const Project& project) {
  std::set<fs::path> folders;
  for (const fs::path& folder : pictureFolders(project.capture(), true)) folders.insert(resolved(folder));
  return folders;
}

void requireOutside(const fs::path& place) {
  if (place.empty()) {
    throw Error(Error::Kind::Usage, "the place to write to is empty; expected the name of a file or folder");
  }
  fs::path at = resolved(place);
  for (;; at = at.parent_path()) {
    if (looksLikeProject(at)) liesIn(place, at, "project");
    if (isCapture(at)) liesIn(place, at, "capture");
    if (at == at.parent_path()) return;
  }
}

void requireFileTarget(const fs::path& file, const OutputRule& rule) {
  requireOutside(file);
  if (const fs::path name = file.filename(); name.empty() || name == "." || name == "..") {
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" names a folder; expected the name of a file in it", file.string()));
  }
  requireOwn(file, rule);
  requireFolder(file.has_parent_path() ? file.parent_path() : fs::path("."));
}

void requireFolderTarget(const fs::path& folder, std::span<const fs::path> files, const OutputRule& rule) {
  requireOutside(folder);
  requireFolder(folder);
  requireNoInput(folder, rule);
  std::set<fs::path> below;
  for (const fs::path& file : files) {
    const fs::path place = (folder / file).parent_path();
    if (below.insert(place).second && place != folder) {
      requireOutside(place);
      requireNoInput(place, rule);
      requireFolder(place, Making::Later);
    }
    requireOwn(folder / file, rule);
  }
}

}  // namespace beam
