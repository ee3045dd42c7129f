// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/frame_store.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <system_error>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/pipeline/file_digest.h"

namespace beam {
namespace {

std::size_t bytesOf(const FrameView& view) {
  return view.photo.pixels.size() * sizeof(u8vec3) + view.mask.pixels.size();
}

ViewIndex viewAt(std::size_t i) { return {static_cast<std::int32_t>(i)}; }

// Empty: whether the files change cannot be told.
std::string stampOf(const std::vector<std::string>& files) {
  std::string all;
  for (const std::string& file : files) {
    const std::string stamp = fileStamp(file);
    if (stamp.empty()) return {};
    all += stamp + ' ';
  }
  return all;
}

// As much again is left to the step.
bool memoryIsThereFor(std::size_t bytes) { return availableMemoryBytes() / 2 >= bytes; }

}  // namespace

struct FrameStore::Slot {
  bool decoded = false;
  std::uint64_t loan = 0;  // that has the view; 0: none
  FrameView view;          // empty: lent, or not readable
  std::string problem;     // why not
  std::string stamp;       // of the files before they were read
  std::size_t bytes = 0;
};

struct FrameStore::Frame {
  FrameIndex index;
  int downscale;
  std::vector<Slot> slots;  // one a view of the capture

  bool needs(const CaptureSet& capture, std::size_t i) const {
    return !slots[i].decoded && capture.views[i].split == Split::Train &&
           capture.source->has(viewAt(i), index);
  }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const Slot& slot : slots) sum += slot.bytes;
    return sum;
  }
  Slot decode(const CaptureSet& capture, std::size_t i, const Progress& progress) const {
    const std::vector<std::string> files = capture.source->files(viewAt(i), index);
    Slot slot;
    // A file that just changed may change again and leave the same stamp.
    if (std::none_of(files.begin(), files.end(), [](const std::string& f) { return justChanged(f); }))
      slot.stamp = stampOf(files);
    try {
      slot.view = loadFrameView(capture, viewAt(i), index, downscale, progress);
    } catch (const Error& e) {
      requireData(e);
      slot.problem = e.what();
    }
    slot.decoded = !slot.problem.empty() || !slot.view.photo.empty();
    slot.bytes = bytesOf(slot.view);
    return slot;
  }
};

struct LentViews::Home {
  std::weak_ptr<FrameStore::Frame> frame;
  std::vector<std::size_t> slots;  // of each view
  std::uint64_t loan;
};

LentViews::LentViews(std::vector<FrameView> own) : views_(std::move(own)) {}

LentViews::LentViews(std::vector<FrameView> views, std::unique_ptr<Home> home)
    : views_(std::move(views)), home_(std::move(home)) {}

LentViews::~LentViews() {
  const std::shared_ptr<FrameStore::Frame> frame = home_ ? home_->frame.lock() : nullptr;
  if (!frame) return;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    FrameStore::Slot& slot = frame->slots[home_->slots[i]];
    if (slot.loan != home_->loan) continue;  // decoded anew meanwhile
    slot.view = std::move(views_[i]);
    slot.loan = 0;
  }
}

FrameStore::FrameStore(const CaptureSet& capture) : capture_(capture) { capture_.seed_points = {}; }

FrameStore::~FrameStore() { dropNext(); }

void FrameStore::expect(std::optional<FrameIndex> next) { expected_ = next; }

LentViews FrameStore::lend(FrameIndex frame, int downscale, const Wanted& wanted, const Progress& progress) {
  if (given_up_) {
    std::vector<FrameView> views = loadFrameViews(capture_, frame, Split::Train, downscale, progress);
    std::erase_if(views, [&](const FrameView& v) { return !wanted(v.name); });
    return LentViews(std::move(views));
  }
  turnTo(frame, downscale, progress);
  dropChanged();
  std::size_t decoded = 0;
  try {
    decoded = fill(progress);
  } catch (const std::bad_alloc&) {
    if (!next_) throw;
    dropNext();
    decoded = fill(progress);
  }
  judge();
  if (expected_ && !next_ && *expected_ != frame && memoryIsThereFor(present_->bytes())) prefetch(downscale);
  logDebug("frame {}: pictures of {} cameras decoded, {:.1f} MB of pictures in memory",
           capture_.frames[static_cast<std::size_t>(frame.value)], decoded,
           static_cast<double>(bytes()) * 1e-6);
  return lendPresent(wanted);
}

LentViews FrameStore::lendPresent(const Wanted& wanted) {
  std::vector<Slot>& slots = present_->slots;
  auto home = std::make_unique<LentViews::Home>(LentViews::Home{present_, {}, ++loans_});
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!slots[i].view.photo.empty() && wanted(slots[i].view.name)) home->slots.push_back(i);
  }
  std::vector<FrameView> views(home->slots.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    Slot& slot = slots[home->slots[v]];
    std::swap(views[v], slot.view);
    slot.loan = loans_;
  }
  return LentViews(std::move(views), std::move(home));
}

bool FrameStore::giveUp() {
  const bool held = present_ || next_;
  dropNext();
  present_.reset();
  given_up_ = true;
  return held;
}

std::size_t FrameStore::bytes() const {
  std::lock_guard lock(mutex_);
  return (present_ ? present_->bytes() : 0) + (next_ ? next_->bytes() : 0);
}

// Never more than two frames: what is neither asked for nor expected goes first.
void FrameStore::turnTo(FrameIndex frame, int downscale, const Progress& progress) {
  if (present_ && present_->index == frame && present_->downscale == downscale) {
    if (!next_ || expected_ == next_->index) return;
    awaitPrefetch(progress);
    return dropNext();
  }
  present_.reset();
  awaitPrefetch(progress);
  if (next_ && next_->index == frame && next_->downscale == downscale) present_ = std::move(next_);
  dropNext();
  if (!present_) present_ = std::make_shared<Frame>(Frame{frame, downscale, {}});
  present_->slots.resize(capture_.views.size());
}

void FrameStore::dropChanged() {
  for (std::size_t i = 0; i < present_->slots.size(); ++i) {
    Slot& slot = present_->slots[i];
    if (!slot.decoded) continue;
    // Who asks for a view that is lent gets one of his own; what failed may be a disk that answers again.
    if (slot.loan != 0 || !slot.problem.empty() || slot.stamp.empty() ||
        slot.stamp != stampOf(capture_.source->files(viewAt(i), present_->index))) {
      slot = {};
    }
  }
}

std::size_t FrameStore::fill(const Progress& progress) {
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < present_->slots.size(); ++i) {
    if (present_->needs(capture_, i)) missing.push_back(i);
  }
  parallelFor(missing.size(), 1, [&](std::size_t m, std::size_t) {
    if (progress.stopRequested()) return;
    present_->slots[missing[m]] = present_->decode(capture_, missing[m], progress);
  });
  progress.check();
  return missing.size();
}

void FrameStore::judge() const {
  std::vector<std::string> problems;
  std::size_t readable = 0;
  for (const Slot& slot : present_->slots) {
    problems.push_back(slot.problem);
    readable += slot.view.photo.empty() ? 0 : 1;
  }
  judgeFrameViews(capture_, present_->index, Split::Train, problems, readable);
}

void FrameStore::prefetch(int downscale) {
  try {
    next_ = std::make_shared<Frame>(Frame{*expected_, downscale, std::vector<Slot>(capture_.views.size())});
    idle_ = false;
    thread_ = std::jthread([this, frame = next_](const std::stop_token& stop) { decodeAhead(stop, *frame); });
  } catch (const std::exception& e) {  // no memory or no thread: the frame is decoded when its turn comes
    logDebug("no pictures are decoded ahead: {}", e.what());
    idle_ = true;
    next_.reset();
  }
}

// One picture at a time: the other cores are the compute pool's.
void FrameStore::decodeAhead(const std::stop_token& stop, Frame& frame) {
  const Progress progress(stop);
  bool failed = false;
  try {
    for (std::size_t i = 0; i < frame.slots.size() && !stop.stop_requested(); ++i) {
      // Without files it cannot be told later whether the picture is still the same.
      if (!frame.needs(capture_, i) || capture_.source->files(viewAt(i), frame.index).empty()) continue;
      Slot slot = frame.decode(capture_, i, progress);
      std::lock_guard lock(mutex_);
      frame.slots[i] = std::move(slot);
    }
  } catch (const std::exception&) {
    failed = true;  // no memory, or a fault that says itself when the frame's turn comes
  }
  std::lock_guard lock(mutex_);
  if (failed) frame.slots.assign(frame.slots.size(), {});
  idle_ = true;
  ended_.notify_all();
}

// What it has not done yet, the whole pool does faster than one thread.
void FrameStore::awaitPrefetch(const Progress& progress) {
  thread_.request_stop();
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, std::chrono::milliseconds(20), [&] { return idle_; })) progress.check();
}

void FrameStore::dropNext() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  next_.reset();
}

}  // namespace beam
