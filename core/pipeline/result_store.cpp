// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/result_store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/file.h"
#include "core/pipeline/file_digest.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr const char* kRecordFile = "result.json";

// Runs `body` with errors of the file system turned into the house's own.
template <class Body>
auto onDisk(Body&& body) {
  try {
    return body();
  } catch (const fs::filesystem_error& e) {
    throw storageError(e);
  }
}

void makeFolder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) {
    throw Error(Error::Kind::Storage,
                fmt::format("cannot make the folder \"{}\": {}", folder.string(), failed.message()));
  }
}

std::vector<std::string> filesBelow(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : entriesBelow(folder)) {
    if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(folder).generic_string());
  }
  return names;
}

std::optional<Digest> keyNamed(const std::string& name) {
  try {
    return parseDigest(name);
  } catch (const Error&) {
    return std::nullopt;  // not ours
  }
}

enum class Kind { Folders, Files };

// None: there is no such file.
std::optional<std::uint64_t> sizeOf(const fs::path& file) {
  std::error_code failed;
  const std::uint64_t bytes = fs::file_size(file, failed);
  if (!failed) return bytes;
  if (lastsUntilChanged(failed.value())) return std::nullopt;
  throw Error(Error::Kind::Storage,
              fmt::format("cannot examine \"{}\": {}", file.string(), failed.message()));
}

// Ascending. Entries with other names are passed over.
std::vector<Digest> keysIn(const fs::path& folder, const std::string& extension, Kind kind) {
  std::vector<Digest> found;
  for (const fs::directory_entry& entry : entriesOf(folder)) {
    // A folder where files are expected, or a file where folders are, is not ours.
    std::error_code gone;
    if (entry.path().extension() != extension || entry.is_directory(gone) != (kind == Kind::Folders))
      continue;
    if (const std::optional<Digest> key = keyNamed(entry.path().stem().string())) found.push_back(*key);
  }
  std::sort(found.begin(), found.end());
  return found;
}

// Entries of the folder whose names begin with a key from the `at`-th letter on, with it.
std::vector<std::pair<Digest, fs::path>> namedByKey(const fs::path& folder, std::size_t at) {
  constexpr std::size_t kHexDigits = 32;
  std::vector<std::pair<Digest, fs::path>> found;
  for (const fs::directory_entry& entry : entriesOf(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= at + kHexDigits || name[at + kHexDigits] != '.') continue;
    if (const auto key = keyNamed(name.substr(at, kHexDigits))) found.emplace_back(*key, entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

// With the key that each was built for.
std::vector<std::pair<Digest, fs::path>> halfBuiltIn(const fs::path& results) {
  std::vector<std::pair<Digest, fs::path>> found = namedByKey(results, 1);
  std::erase_if(found, [](const auto& entry) {
    const std::string name = entry.second.filename().string();
    return name.front() != '.' || !name.ends_with(".tmp");
  });
  return found;
}

// Everything in the folder to the disk, and what it is into the record.
void sealFiles(const fs::path& folder, ResultRecord& record) {
  record.files.clear();
  for (const std::string& name : filesBelow(folder)) {
    const fs::path file = folder / name;
    syncPath(file);
    record.files[name] = {fs::file_size(file), digestOfFile(file)};
  }
  for (const fs::directory_entry& entry : entriesBelow(folder)) {
    if (entry.is_directory()) syncPath(entry.path());
  }
  writeFileAtomically(folder / kRecordFile, toJson(record));
}

std::string stampOf(const fs::path& folder, const ResultRecord& record) {
  std::string stamp = fileStamp(folder / kRecordFile);
  for (const auto& [name, entry] : record.files) stamp.append(1, '|').append(fileStamp(folder / name));
  return stamp;
}

}  // namespace

fs::path ResultStore::folderOf(const Digest& key) const { return project_ / "results" / key.hex(); }

std::optional<fs::file_time_type> ResultStore::publishedAt(const Digest& key) const {
  std::error_code failed;
  const fs::file_time_type time = fs::last_write_time(folderOf(key) / kRecordFile, failed);
  return failed ? std::nullopt : std::optional(time);
}

std::vector<ResultRecord> ResultStore::recordsByAge() const {
  std::vector<std::pair<fs::file_time_type, ResultRecord>> dated;
  for (const Digest& key : keys()) {
    const std::optional<fs::file_time_type> time = publishedAt(key);
    if (std::optional<ResultRecord> found = record(key); found && time)
      dated.emplace_back(*time, std::move(*found));
  }
  std::stable_sort(dated.begin(), dated.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ResultRecord> records;
  for (auto& [time, found] : dated) records.push_back(std::move(found));
  return records;
}

std::vector<Digest> ResultStore::keys() const { return keysIn(project_ / "results", "", Kind::Folders); }

fs::path ResultStore::checkpointOf(const Digest& key) const { return project_ / "checkpoints" / key.hex(); }

void ResultStore::clearCheckpoint(const Digest& key) const {
  std::error_code ignored;
  fs::remove_all(checkpointOf(key), ignored);
}

std::vector<Digest> ResultStore::checkpoints() const {
  return keysIn(project_ / "checkpoints", "", Kind::Folders);
}

std::vector<Digest> ResultStore::leases() const { return keysIn(project_ / "leases", "", Kind::Files); }

std::vector<Digest> ResultStore::failures() const {
  return keysIn(project_ / "failures", ".json", Kind::Files);
}

fs::path ResultStore::halfBuiltFolderOf(const Digest& key) const {
  return project_ / "results" / fmt::format(".{}.{}.tmp", key.hex(), ::getpid());
}

std::optional<ResultRecord> ResultStore::record(const Digest& key) const {
  const fs::path file = folderOf(key) / kRecordFile;
  if (!isThere(file)) return std::nullopt;
  try {
    ResultRecord record = parseResultRecord(readTextFile(file));
    if (record.key == key) return record;
  } catch (const Error& e) {
    requireData(e);  // it is not finished; `verified` says so aloud and sets it aside
  }
  return std::nullopt;
}

bool ResultStore::has(const Digest& key) const {
  const std::optional<ResultRecord> found = record(key);
  if (!found) return false;
  return std::all_of(found->files.begin(), found->files.end(), [&](const auto& file) {
    return sizeOf(folderOf(key) / file.first) == file.second.bytes;
  });
}

std::string ResultStore::findDamage(const Digest& key, const ResultRecord& record) const {
  for (const auto& [name, entry] : record.files) {
    const fs::path file = folderOf(key) / name;
    const std::optional<std::uint64_t> bytes = sizeOf(file);
    if (!bytes) return fmt::format("{} is missing", name);
    if (*bytes != entry.bytes)
      return fmt::format("{}: expected {} bytes, found {}", name, entry.bytes, *bytes);
    if (const Digest found = digestOfFile(file); found != entry.digest) {
      return fmt::format("{}: expected digest {}, found {}", name, entry.digest.hex(), found.hex());
    }
  }
  return {};
}

std::optional<fs::path> ResultStore::verified(const Digest& key) const {
  const fs::path folder = folderOf(key);
  if (!isThere(folder)) return std::nullopt;
  const std::optional<ResultRecord> found = record(key);
  if (!found) {
    quarantine(key, "result.json is missing or cannot be understood");
    return std::nullopt;
  }
  const std::string stamp = stampOf(folder, *found);
  {
    std::lock_guard lock(mutex_);
    if (const auto known = good_.find(key); known != good_.end() && known->second == stamp) return folder;
  }
  if (const std::string damage = findDamage(key, *found); !damage.empty()) {
    quarantine(key, damage);
    return std::nullopt;
  }
  std::lock_guard lock(mutex_);
  good_[key] = stamp;
  return folder;
}

void ResultStore::quarantine(const Digest& key, const std::string& reason) const {
  const fs::path folder = folderOf(key);
  std::string what = "it is set aside in quarantine/ and will be computed again";
  try {
    makeFolder(project_ / "quarantine");
    fs::path aside;
    int n = 0;
    do aside = project_ / "quarantine" / fmt::format("{}.{}", key.hex(), n++);
    while (fs::exists(aside));
    fs::rename(folder, aside);
    syncPath(project_ / "results");
  } catch (const std::exception&) {
    what = "the project cannot be written, so it stays where it is and is not used";
  }
  logWarning("\"{}\" is damaged: {}; {}", folder.string(), reason, what);
}

std::optional<FileLock> ResultStore::tryLease(const Digest& key) const {
  makeFolder(project_ / "leases");
  std::optional<FileLock> lease = FileLock::tryAcquire(project_ / "leases" / key.hex());
  if (lease) lease->removeFileAtRelease();
  return lease;
}

bool ResultStore::isLeased(const Digest& key) const {
  return FileLock::isHeld(project_ / "leases" / key.hex());
}

std::string ResultStore::leaseHolder(const Digest& key) const {
  const std::string holder = FileLock::shortHolderOf(project_ / "leases" / key.hex());
  return holder.empty() ? "another process" : holder;
}

void ResultStore::publish(const Digest& key, ResultRecord record, const Build& build) const {
  const fs::path results = project_ / "results";
  makeFolder(results);
  const fs::path temporary = halfBuiltFolderOf(key);
  onDisk([&] { fs::remove_all(temporary); });
  makeFolder(temporary);
  try {
    record.key = key;
    onDisk([&] { build(temporary, record); });
    onDisk([&] { sealFiles(temporary, record); });
    const fs::path target = folderOf(key);
    if (::rename(temporary.c_str(), target.c_str()) != 0) {
      if (errno != EEXIST && errno != ENOTEMPTY) {
        throw Error(Error::Kind::Storage, fmt::format("cannot rename \"{}\" into place: {}",
                                                      temporary.string(), std::strerror(errno)));
      }
      // Somebody without a lease was faster: theirs stands if it is whole, and `verified` moves it away if
      // not.
      if (!verified(key)) onDisk([&] { fs::rename(temporary, target); });
    }
    syncPath(results);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(temporary, ignored);
    throw;
  }
  std::error_code ignored;
  fs::remove_all(temporary, ignored);
}

void ResultStore::discard(const Digest& key) const {
  const fs::path aside = halfBuiltFolderOf(key);
  onDisk([&] {
    fs::remove_all(aside);  // of a process that had our number and died
    fs::rename(folderOf(key), aside);
  });
  std::lock_guard lock(mutex_);
  good_.erase(key);
}

std::vector<fs::path> ResultStore::stale() const {
  std::vector<fs::path> found;
  for (const auto& [key, folder] : halfBuiltIn(project_ / "results")) {
    if (!isLeased(key)) found.push_back(folder);
  }
  return found;
}

void ResultStore::removeStale(Progress& progress) const {
  const std::vector<std::pair<Digest, fs::path>> found = halfBuiltIn(project_ / "results");
  if (found.empty()) return;
  // That a result was discarded is on the disk before its files go: never is half a result found as one.
  syncPath(project_ / "results");
  progress.expect(static_cast<std::int64_t>(found.size()), "folders");
  for (const auto& [key, folder] : found) {
    // The builder of a folder holds the lease of its key; a lease that can be had has no builder.
    const std::optional<FileLock> lease = tryLease(key);
    if (lease) {
      onDisk([&, &folder = folder] {
        const bool is_folder = fs::is_directory(fs::symlink_status(folder));
        for (const std::string& name : is_folder ? filesBelow(folder) : std::vector<std::string>()) {
          progress.check();
          fs::remove(folder / name);
        }
        fs::remove_all(folder);
      });
    }
    progress.step();
  }
}

std::vector<fs::path> ResultStore::setAside() const {
  std::vector<fs::path> found;
  for (auto& [key, folder] : namedByKey(project_ / "quarantine", 0)) found.push_back(std::move(folder));
  return found;
}

void ResultStore::noteFailure(const Digest& key, const FailureNote& note) const {
  makeFolder(project_ / "failures");
  writeFileAtomically(project_ / "failures" / (key.hex() + ".json"), toJson(note));
}

void ResultStore::clearFailure(const Digest& key) const {
  std::error_code ignored;
  fs::remove(project_ / "failures" / (key.hex() + ".json"), ignored);
}

std::optional<FailureNote> ResultStore::failure(const Digest& key) const {
  const fs::path file = project_ / "failures" / (key.hex() + ".json");
  if (!isThere(file)) return std::nullopt;
  try {
    return parseFailureNote(readTextFile(file));
  } catch (const Error& e) {
    requireData(e);
    return std::nullopt;
  }
}

}  // namespace beam
