// SPDX-License-Identifier: Apache-2.0
#include "ui/frame_cache.h"

#include <algorithm>

#include "core/base/memory.h"

namespace beam {
namespace {

template <class T>
std::uint64_t bytesIn(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

}  // namespace

FrameValues valuesOf(std::shared_ptr<const GaussianFrame> frame) {
  FrameValues values;
  if (!frame) return values;
  values.interpolated = frame->interpolated;
  values.stale = frame->stale;
  values.stale_note = frame->stale_note;
  if (frame->materials) values.materials = {frame, &*frame->materials};
  values.attributes = {frame, &frame->attributes};
  const GaussianCloud* cloud = &frame->cloud;
  values.cloud = {std::move(frame), cloud};
  return values;
}

std::vector<RenderInstance> instancesOf(const FrameValues& values) {
  if (!values.cloud) return {};
  return {{.cloud = values.cloud, .materials = values.materials, .attributes = values.attributes}};
}

std::uint64_t bytesOf(const FrameValues& v) {
  std::uint64_t bytes = 0;
  if (v.cloud) {
    bytes += bytesIn(v.cloud->position_m) + bytesIn(v.cloud->rotation) + bytesIn(v.cloud->scale_m) +
             bytesIn(v.cloud->opacity) + bytesIn(v.cloud->color.coefficients);
  }
  if (v.materials) {
    bytes += bytesIn(v.materials->roughness) + bytesIn(v.materials->base_color.coefficients) +
             bytesIn(v.materials->ambient_occlusion.coefficients);
  }
  if (v.attributes) {
    for (const Attribute& a : *v.attributes) bytes += bytesIn(a.values);
  }
  if (v.mesh) bytes += bytesIn(v.mesh->vertices) + bytesIn(v.mesh->triangles);
  return bytes;
}

std::uint64_t defaultFrameBudget() {
  constexpr std::uint64_t kMost = 2'000'000'000;
  return std::min(kMost, availableMemoryBytes() / 4);
}

FrameCache::FrameCache(std::uint64_t budget_bytes, std::function<void(FrameIndex)> arrived)
    : budget_(budget_bytes),
      arrived_(std::move(arrived)),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

FrameCache::~FrameCache() {
  thread_.request_stop();
  thread_.join();
}

void FrameCache::clear() {
  std::lock_guard lock(mutex_);
  wishes_.clear();
  entries_.clear();
  bytes_ = 0;
  full_ = false;
  ++generation_;
}

std::optional<FrameCache::Found> FrameCache::find(const GaussianSequence& sequence, FrameIndex frame) {
  std::lock_guard lock(mutex_);
  const auto found = entries_.find({sequence.id(), frame.value});
  if (found == entries_.end()) return std::nullopt;
  Entry& entry = found->second;
  entry.used = ++uses_;
  return Found{entry.values, entry.error, entry.stamp == sequence.stamp(frame)};
}

// Null: there is none, or of another result.
const FrameCache::Entry* FrameCache::currentEntry(const GaussianSequence& sequence, FrameIndex frame) const {
  const auto found = entries_.find({sequence.id(), frame.value});
  const bool current = found != entries_.end() && found->second.stamp == sequence.stamp(frame);
  return current ? &found->second : nullptr;
}

bool FrameCache::isBlank(const GaussianSequence& sequence, FrameIndex frame) const {
  std::lock_guard lock(mutex_);
  const Entry* entry = currentEntry(sequence, frame);
  return entry && !entry->values.cloud && entry->error.empty();
}

void FrameCache::want(std::vector<SequenceFrame> wishes) {
  {
    std::lock_guard lock(mutex_);
    wishes_ = std::move(wishes);
    full_ = false;
  }
  changed_.notify_all();
}

bool FrameCache::isWished(const Key& key) const {
  return std::any_of(wishes_.begin(), wishes_.end(), [&](const SequenceFrame& wish) {
    return wish.frame.value == key.second && wish.sequence->id() == key.first;
  });
}

// Frames of a take are of a size: one more like those that are held would push out a wished one.
bool FrameCache::noRoomLikely() const {
  std::uint64_t largest = 0;
  for (const auto& [key, entry] : entries_) {
    if (!isWished(key)) return false;
    largest = std::max(largest, entry.bytes);
  }
  return bytes_ + largest > budget_;
}

std::optional<SequenceFrame> FrameCache::nextWish() const {
  for (std::size_t i = 0; i < wishes_.size(); ++i) {
    if (currentEntry(*wishes_[i].sequence, wishes_[i].frame)) continue;
    if (i > 0 && (full_ || noRoomLikely())) return std::nullopt;
    return wishes_[i];
  }
  return std::nullopt;
}

// Makes room first: what nobody wishes for, least recently used first; for the most urgent wish everything.
bool FrameCache::insert(const Key& key, Entry entry) {
  const bool urgent = wishes_.empty() || keyOf(wishes_.front()) == key;
  const auto drop = [this](auto at) {
    bytes_ -= at->second.bytes;
    entries_.erase(at);
  };
  if (const auto old = entries_.find(key); old != entries_.end()) drop(old);
  while (bytes_ + entry.bytes > budget_ && !entries_.empty()) {
    auto victim = entries_.end();
    for (auto i = entries_.begin(); i != entries_.end(); ++i) {
      const bool spared = isWished(i->first) && !urgent;
      if (!spared && (victim == entries_.end() || i->second.used < victim->second.used)) victim = i;
    }
    if (victim == entries_.end()) break;
    drop(victim);
  }
  if (bytes_ + entry.bytes > budget_ && !urgent) {
    full_ = true;
    return false;
  }
  entry.used = ++uses_;
  bytes_ += entry.bytes;
  entries_.emplace(key, std::move(entry));
  return true;
}

void FrameCache::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return nextWish().has_value(); })) {
    if (stop.stop_requested()) return;
    const SequenceFrame wish = *nextWish();
    const std::uint64_t generation = generation_;
    Entry entry;
    reading_ = true;
    lock.unlock();
    entry.stamp = wish.sequence->stamp(wish.frame);
    try {
      entry.values = valuesOf(wish.sequence->load(wish.frame));
    } catch (const std::exception& e) {  // the border of this thread: whoever looks for the frame is told
      entry.error = e.what();
    }
    entry.bytes = bytesOf(entry.values);
    lock.lock();
    const bool kept = generation == generation_ && insert(keyOf(wish), std::move(entry));
    lock.unlock();
    if (kept) arrived_(wish.frame);
    lock.lock();
    reading_ = false;
  }
}

std::vector<bool> FrameCache::held(const GaussianSequence& sequence) const {
  std::lock_guard lock(mutex_);
  std::vector<bool> held(sequence.frames().size());
  for (std::size_t f = 0; f < held.size(); ++f) {
    const Entry* entry = currentEntry(sequence, FrameIndex{static_cast<std::int32_t>(f)});
    held[f] = entry && entry->values.cloud;
  }
  return held;
}

std::uint64_t FrameCache::bytes() const {
  std::lock_guard lock(mutex_);
  return bytes_;
}

bool FrameCache::idle() const {
  std::lock_guard lock(mutex_);
  return !reading_ && !nextWish();
}

}  // namespace beam
