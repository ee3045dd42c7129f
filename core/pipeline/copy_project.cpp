// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/copy_project.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <vector>

#include "core/base/error.h"
#include "core/base/file_reference.h"
#include "core/io/file.h"
#include "core/pipeline/output_target.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

fs::path plain(const fs::path& path) {
  const fs::path whole = fs::weakly_canonical(fs::absolute(path));
  return whole.has_filename() ? whole : whole.parent_path();
}

void checkTarget(const fs::path& from, const fs::path& to) {
  if (isAtOrBelow(to, from) || isAtOrBelow(from, to)) {
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" cannot be copied into itself or around itself: choose a folder beside "
                            "it, not \"{}\"",
                            from.string(), to.string()));
  }
  requireOutside(to);
  if (fs::exists(to) && !(fs::is_directory(to) && fs::is_empty(to))) {
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" exists and is not an empty folder; choose another name for the copy",
                            to.string()));
  }
}

// Removes what it holds unless it was kept.
class Unfinished {
 public:
  explicit Unfinished(fs::path folder) : folder_(std::move(folder)) {}
  ~Unfinished() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  void keep() { folder_.clear(); }

 private:
  fs::path folder_;
};

class Copier {
 public:
  Copier(const Project& from, fs::path into) : from_(from), into_(std::move(into)) {}

  void results(Progress& progress) {
    const std::vector<Digest> keys = from_.store().keys();
    progress.expect(static_cast<std::int64_t>(keys.size()));
    fs::create_directory(into_ / "results");
    for (const Digest& key : keys) {
      if (from_.store().has(key)) result(key);
      progress.step();
    }
    syncPath(into_ / "results");
  }

  void failures() {
    for (const fs::directory_entry& entry : entriesOf(from_.folder() / "failures")) {
      fs::create_directory(into_ / "failures");
      file(entry.path(), into_ / "failures" / entry.path().filename());
    }
  }

 private:
  void result(const Digest& key) {
    const fs::path source = from_.store().folderOf(key);
    const fs::path target = into_ / "results" / key.hex();
    const std::optional<ResultRecord> record = from_.store().record(key);
    if (!record) return;  // set aside a moment ago
    std::set<fs::path> folders{target};
    fs::create_directory(target);
    for (const auto& [name, entry] : record->files) {
      const fs::path copy = target / name;
      fs::create_directories(copy.parent_path());
      folders.insert(copy.parent_path());
      file(source / name, copy);
    }
    file(source / "result.json", target / "result.json");
    for (const fs::path& folder : folders) syncPath(folder);
  }

  void file(const fs::path& source, const fs::path& target) {
    std::error_code failed;
    if (link_) fs::create_hard_link(source, target, failed);
    if (link_ && !failed) return;
    link_ = false;  // another file system, or one without links: it stays so for all
    fs::copy_file(source, target);
    fs::last_write_time(target, fs::last_write_time(source));  // results are told apart by age
    syncPath(target);
  }

  const Project& from_;
  fs::path into_;
  bool link_ = true;
};

FileReference moved(const FileReference& reference, const fs::path& from, const fs::path& to) {
  const std::optional<fs::path> found = resolve(reference, from);
  return referenceTo(found ? *found : fs::path(reference.absolute), to);
}

void moveReferences(ProjectDocument& document, const fs::path& from, const fs::path& to) {
  const auto move = [&](FileReference& reference) {
    if (!reference.empty()) reference = moved(reference, from, to);
  };
  if (!document.capture.absolute.empty()) move(document.capture);
  if (document.environment) move(*document.environment);
  for (Look& look : document.looks) {
    move(look.lighting.environment.file);
    move(look.camera_path.file);
  }
}

void copyChecked(const Project& from, const fs::path& source, const fs::path& to, bool with_results,
                 Progress& progress) {
  checkTarget(source, to);
  if (from.captureIsThere() && isAtOrBelow(to, plain(from.captureFolder()))) {
    throw Error(
        Error::Kind::Usage,
        fmt::format("\"{}\" lies in the capture, into which nothing is written; choose a folder beside it",
                    to.string()));
  }
  fs::create_directories(to.parent_path());
  const fs::path half = to.parent_path() / fmt::format(".{}.{}.copy", to.filename().string(), ::getpid());
  fs::remove_all(half);
  Unfinished unfinished(half);
  fs::create_directory(half);
  if (with_results) {
    Copier copier(from, half);
    copier.failures();
    copier.results(progress);
  }
  progress.check();
  ProjectDocument document = from.document();
  document.id = newProjectId();
  document.world = from.world();
  moveReferences(document, source, to);
  writeProjectDocument(half, document);
  syncPath(half);
  fs::rename(half, to);  // takes the place of an empty folder
  unfinished.keep();
  syncPath(to.parent_path());
}

}  // namespace

void copyProject(const Project& from, const fs::path& to, bool with_results, Progress& progress) {
  try {
    copyChecked(from, plain(from.folder()), plain(to), with_results, progress);
  } catch (const fs::filesystem_error& e) {
    throw storageError(e);
  }
}

}  // namespace beam
