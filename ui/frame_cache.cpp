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
  load_ = nullptr;
  stamps_.clear();
  wishes_.clear();
  entries_.clear();
  bytes_ = 0;
  full_ = false;
  ++generation_;
}

void FrameCache::setSource(Load load, std::vector<Digest> stamps) {
  {
    std::lock_guard lock(mutex_);
    load_ = std::move(load);
    stamps_ = std::move(stamps);
    full_ = false;
  }
  changed_.notify_all();
}

std::optional<Digest> FrameCache::stampOf(FrameIndex frame) const {
  const auto i = static_cast<std::size_t>(frame.value);
  return i < stamps_.size() ? std::optional(stamps_[i]) : std::nullopt;
}

bool FrameCache::isCurrent(const Entry& entry, FrameIndex frame) const {
  return entry.stamp == stampOf(frame);
}

std::optional<FrameCache::Found> FrameCache::find(FrameIndex frame) {
  std::lock_guard lock(mutex_);
  const auto found = entries_.find(frame.value);
  if (found == entries_.end()) return std::nullopt;
  found->second.used = ++uses_;
  return Found{found->second.values, found->second.error, isCurrent(found->second, frame)};
}

bool FrameCache::isBlank(FrameIndex frame) const {
  std::lock_guard lock(mutex_);
  const auto found = entries_.find(frame.value);
  return found != entries_.end() && isCurrent(found->second, frame) && !found->second.values.cloud &&
         found->second.error.empty();
}

void FrameCache::want(std::vector<FrameIndex> wishes) {
  {
    std::lock_guard lock(mutex_);
    wishes_ = std::move(wishes);
    full_ = false;
  }
  changed_.notify_all();
}

bool FrameCache::isWished(FrameIndex frame) const {
  return std::find(wishes_.begin(), wishes_.end(), frame) != wishes_.end();
}

// Frames of a take are of a size: one more like those that are held would push out a wished one.
bool FrameCache::noRoomLikely() const {
  std::uint64_t largest = 0;
  for (const auto& [frame, entry] : entries_) {
    if (!isWished(FrameIndex{frame})) return false;
    largest = std::max(largest, entry.bytes);
  }
  return bytes_ + largest > budget_;
}

std::optional<FrameIndex> FrameCache::nextWish() const {
  if (!load_) return std::nullopt;
  for (std::size_t i = 0; i < wishes_.size(); ++i) {
    const auto entry = entries_.find(wishes_[i].value);
    if (entry != entries_.end() && isCurrent(entry->second, wishes_[i])) continue;
    if (i > 0 && (full_ || noRoomLikely())) return std::nullopt;
    return wishes_[i];
  }
  return std::nullopt;
}

// Makes room first: what nobody wishes for, least recently used first; for the most urgent wish everything.
bool FrameCache::insert(FrameIndex frame, Entry entry) {
  const bool urgent = wishes_.empty() || wishes_.front() == frame;
  const auto drop = [this](auto at) {
    bytes_ -= at->second.bytes;
    entries_.erase(at);
  };
  if (const auto old = entries_.find(frame.value); old != entries_.end()) drop(old);
  while (bytes_ + entry.bytes > budget_ && !entries_.empty()) {
    auto victim = entries_.end();
    for (auto i = entries_.begin(); i != entries_.end(); ++i) {
      const bool spared = isWished(FrameIndex{i->first}) && !urgent;
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
  entries_.emplace(frame.value, std::move(entry));
  return true;
}

void FrameCache::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return nextWish().has_value(); })) {
    if (stop.stop_requested()) return;
    const FrameIndex frame = *nextWish();
    const Load load = load_;
    const std::uint64_t generation = generation_;
    Entry entry;
    entry.stamp = stampOf(frame);
    reading_ = true;
    lock.unlock();
    try {
      entry.values = load(frame);
    } catch (const std::exception& e) {  // the border of this thread: whoever looks for the frame is told
      entry.error = e.what();
    }
    entry.bytes = bytesOf(entry.values);
    lock.lock();
    const bool kept = generation == generation_ && insert(frame, std::move(entry));
    lock.unlock();
    if (kept) arrived_(frame);
    lock.lock();
    reading_ = false;
  }
}

std::vector<bool> FrameCache::held(std::size_t frames) const {
  std::lock_guard lock(mutex_);
  std::vector<bool> held(frames);
  for (const auto& [frame, entry] : entries_) {
    if (static_cast<std::size_t>(frame) < frames)
      held[frame] = entry.values.cloud != nullptr && isCurrent(entry, FrameIndex{frame});
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
