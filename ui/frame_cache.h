// SPDX-License-Identifier: Apache-2.0
// Decoded frames of sequences in memory, within one budget for all of them: the least recently used go first,
// wishes are read on a background thread in the order of their urgency.
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
#include <utility>
#include <vector>

#include "core/scene/gaussian_sequence.h"
#include "core/scene/render_scene.h"

namespace beam {

struct FrameValues {
  std::shared_ptr<const GaussianCloud> cloud;  // null: not there yet
  std::shared_ptr<const Materials> materials;
  std::shared_ptr<const std::vector<Attribute>> attributes;
  std::shared_ptr<const Mesh> mesh;
  bool interpolated = false;  // between two solved frames of a scout run
  bool stale = false;         // not what the settings in force would give; `stale_note` says what of it
  std::string stale_note = {};
};

// What there is to draw; none without Gaussians.
std::vector<RenderInstance> instancesOf(const FrameValues& values);
FrameValues valuesOf(std::shared_ptr<const GaussianFrame> frame);  // null: nothing
std::uint64_t bytesOf(const FrameValues& values);
// What a machine can spare: 2 GB or a quarter of its memory, whichever is less.
std::uint64_t defaultFrameBudget();

struct SequenceFrame {
  std::shared_ptr<const GaussianSequence> sequence;
  FrameIndex frame;
};

// Safe to use from several threads. A frame is kept under its sequence's id: snapshots of one source share
// what was read, as long as its stamp stays the same.
class FrameCache {
 public:
  // `arrived` is called on the cache's thread when a frame came into memory (or could not be read).
  FrameCache(std::uint64_t budget_bytes, std::function<void(FrameIndex)> arrived);
  ~FrameCache();

  void clear();

  struct Found {
    FrameValues values;
    std::string error;    // why it could not be read
    bool current = true;  // false: there is a newer result than this one
  };
  // Counts as use.
  std::optional<Found> find(const GaussianSequence& sequence, FrameIndex frame);
  // Read, and there is nothing to see: results of early steps alone.
  bool isBlank(const GaussianSequence& sequence, FrameIndex frame) const;
  // Replaces earlier wishes. The first is read in any case, the others as far as the budget goes.
  void want(std::vector<SequenceFrame> wishes);

  std::vector<bool> held(const GaussianSequence& sequence) const;  // by frame: current values are in memory
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
  using Key = std::pair<std::string, std::int32_t>;  // the sequence's id, frame
  static Key keyOf(const SequenceFrame& wish) { return {wish.sequence->id(), wish.frame.value}; }
  void work(const std::stop_token& stop);
  const Entry* currentEntry(const GaussianSequence& sequence, FrameIndex frame) const;
  std::optional<SequenceFrame> nextWish() const;
  bool insert(const Key& key, Entry entry);
  bool isWished(const Key& key) const;
  bool noRoomLikely() const;

  const std::uint64_t budget_;
  const std::function<void(FrameIndex)> arrived_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::vector<SequenceFrame> wishes_;
  std::map<Key, Entry> entries_;
  std::uint64_t bytes_ = 0, uses_ = 0, generation_ = 0;
  bool full_ = false;  // what is still wished for does not fit beside what is more urgent
  bool reading_ = false;
  std::jthread thread_;  // last: it stops first
};

}  // namespace beam
