// SPDX-License-Identifier: Apache-2.0
// The folder of immutable results: published whole or not at all, verified when read, never overwritten, so
// that what was called finished survives a kill or a power cut. Safe to use from several threads and
// processes.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/base/progress.h"
#include "core/pipeline/file_lock.h"
#include "core/pipeline/result_record.h"

namespace beam {

class ResultStore {
 public:
  explicit ResultStore(std::filesystem::path project) : project_(std::move(project)) {}

  std::filesystem::path folderOf(const Digest& key) const;

  // Of all that is in results/, finished or damaged, ascending.
  std::vector<Digest> keys() const;
  // Whether result.json is there and every file has its size; reads no file's bytes.
  bool has(const Digest& key) const;
  std::optional<ResultRecord> record(const Digest& key) const;
  // Of result.json, which is written last; empty when there is none.
  std::optional<std::filesystem::file_time_type> publishedAt(const Digest& key) const;
  // Of every finished result, the newest last.
  std::vector<ResultRecord> recordsByAge() const;
  // Folder of a result whose every byte was verified by this process; empty when there is none. A damaged one
  // is moved to quarantine/ (where the project can be written) with a warning and counts as none.
  std::optional<std::filesystem::path> verified(const Digest& key) const;

  // Who computes `key` holds its lease. Empty when somebody else does.
  std::optional<FileLock> tryLease(const Digest& key) const;
  bool isLeased(const Digest& key) const;
  // "process 123", of another machine "process 123 on host h"; "another process" when that is not known.
  std::string leaseHolder(const Digest& key) const;

  // Lets `build` fill a folder and makes it the result: files synced and hashed, `record` completed with them
  // and written last, folder renamed, results/ synced. After it returns, the result survives anything. The
  // caller holds the lease. Whatever build throws leaves nothing behind.
  using Build = std::function<void(const std::filesystem::path& folder, ResultRecord& record)>;
  void publish(const Digest& key, ResultRecord record, const Build& build) const;

  // Takes a result out of results/: from now on it counts as none, and its folder as a half-built one, which
  // removeStale deletes. The caller holds the lease.
  void discard(const Digest& key) const;
  // Half-built folders that no living process works on, and those of discarded results.
  std::vector<std::filesystem::path> stale() const;
  // Deletes these; looks for a stop between two files. A kill in the middle leaves the rest to the next time.
  void removeStale(Progress& progress) const;
  // Damaged results that were moved to quarantine/.
  std::vector<std::filesystem::path> setAside() const;

  // What is computed so far of a result (CheckpointFiles). The caller holds the lease.
  std::filesystem::path checkpointOf(const Digest& key) const;
  void clearCheckpoint(const Digest& key) const;

  // Whose files are in checkpoints/, leases/ and failures/, ascending. A file of a lease need not be held: a
  // kill leaves it.
  std::vector<Digest> checkpoints() const;
  std::vector<Digest> leases() const;
  std::vector<Digest> failures() const;

  void noteFailure(const Digest& key, const FailureNote& note) const;
  void clearFailure(const Digest& key) const;
  std::optional<FailureNote> failure(const Digest& key) const;

 private:
  std::string findDamage(const Digest& key, const ResultRecord& record) const;
  void quarantine(const Digest& key, const std::string& reason) const;
  std::filesystem::path halfBuiltFolderOf(const Digest& key) const;

  std::filesystem::path project_;
  mutable std::mutex mutex_;
  mutable std::map<Digest, std::string> good_;  // key -> stamp of the files as they were when verified
};

}  // namespace beam
