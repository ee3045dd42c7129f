// SPDX-License-Identifier: Apache-2.0
// Decoded frames in memory, within a budget: the least recently used go first, wishes are read on a
// background thread in the order of their urgency.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/hash.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/ids.h"
#include "core/scene/mesh.h"

namespace beam {

struct FrameValues {
  std::shared_ptr<const GaussianCloud> cloud;  // null: not there yet
  std::shared_ptr<const Materials> materials;
  std::shared_ptr<const Mesh> mesh;
  bool interpolated = false;  // between two solved frames of a scout run
  bool stale = false;         // not what the settings in force would give; `stale_note` says what of it
  std::string stale_note = {};
};

std::uint64_t bytesOf(const FrameValues& values);
// What a machine can spare: 2 GB or a quarter of its memory, whichever is less.
std::uint64_t defaultFrameBudget();

// Safe to use from several threads.
class FrameCache {
 public:
  using Load = std::function<FrameValues(FrameIndex)>;  // on the cache's thread; may throw
  // `arrived` is called on the cache's thread when a frame came into memory (or could not be read).
  FrameCache(std::uint64_t budget_bytes, std::function<void(FrameIndex)> arrived);
  ~FrameCache();

  void clear();
  // Where frames come from and, by frame, what their results are: a frame under another stamp is read again
  // when wished for. No stamps: not known yet, everything is read.
  void setSource(Load load, std::vector<Digest> stamps);

  struct Found {
    FrameValues values;
    std::string error;    // why it could not be read
    bool current = true;  // false: there is a newer result than this one
  };
  // Counts as use.
  std::optional<Found> find(FrameIndex frame);
  // Read, and there is nothing to see: results of early steps alone.
  bool isBlank(FrameIndex frame) const;
  // Replaces earlier wishes. The first is read in any case, the others as far as the budget goes.
  void want(std::vector<FrameIndex> wishes);

  std::vector<bool> held(std::size_t frames) const;  // by frame: current values are in memory
  std::uint64_t bytes() const;
  std::uint64_t budget() const { return budget_; }
  bool idle() const;  // nothing is being read or will be

 private:
  struct Entry {
    FrameValues values;
    std::string error;
    std::optional<Digest> stamp;
    std::uint64_t bytes = 0, used = 0;  // used: larger is later
  };
  void work(const std::stop_token& stop);
  bool isCurrent(const Entry& entry, FrameIndex frame) const;
  std::optional<Digest> stampOf(FrameIndex frame) const;
  std::optional<FrameIndex> nextWish() const;
  bool insert(FrameIndex frame, Entry entry);
  bool isWished(FrameIndex frame) const;
  bool noRoomLikely() const;

  const std::uint64_t budget_;
  const std::function<void(FrameIndex)> arrived_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  Load load_;
  std::vector<Digest> stamps_;
  std::vector<FrameIndex> wishes_;
  std::map<std::int32_t, Entry> entries_;
  std::uint64_t bytes_ = 0, uses_ = 0, generation_ = 0;
  bool full_ = false;  // what is still wished for does not fit beside what is more urgent
  bool reading_ = false;
  std::jthread thread_;  // last: it stops first
};

}  // namespace beam
