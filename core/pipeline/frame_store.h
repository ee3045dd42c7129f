// SPDX-License-Identifier: Apache-2.0
// FrameStore: the decoded training pictures of the frame at work, lent to one step after the other, and of
// the frame after it, decoded on a thread of its own meanwhile. Never more than these two frames: of 81 views
// at 3840 x 2160 that is 2 x 2.7 GB. What a step gets and is told is what loadFrameViews would give and tell.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/scene/frame_views.h"

namespace beam {

// Views on loan; the destructor gives them back to the store. Or views of one's own.
class LentViews {
 public:
  explicit LentViews(std::vector<FrameView> own);
  ~LentViews();
  LentViews(const LentViews&) = delete;
  LentViews& operator=(const LentViews&) = delete;

  const std::vector<FrameView>& all() const& { return views_; }
  // The pictures would go back while they are looked at.
  const std::vector<FrameView>& all() const&& = delete;

 private:
  friend class FrameStore;
  struct Home;
  LentViews(std::vector<FrameView> views, std::unique_ptr<Home> home);

  std::vector<FrameView> views_;
  std::unique_ptr<Home> home_;  // null: they are one's own
};

// All calls, loans included, come from the thread of the job.
class FrameStore {
 public:
  using Wanted = std::function<bool(const std::string& view)>;

  explicit FrameStore(const CaptureSet& capture);
  ~FrameStore();  // waits until the picture that is being decoded is done

  // The frame that comes after the one at work; its pictures are decoded once those at work are. None: no
  // other has pictures to read.
  void expect(std::optional<FrameIndex> next);
  // The training views of `frame`, now the one at work, that are `wanted`. A picture whose files changed
  // since it was decoded, or less than two seconds before, or that could not be read, is decoded anew.
  LentViews lend(FrameIndex frame, int downscale, const Wanted& wanted, const Progress& progress);
  // For when memory is short: lets all pictures go, and keeps none from now on. False: it has none.
  bool giveUp();
  // Of all pictures that it holds or has lent.
  std::size_t bytes() const;

 private:
  friend class LentViews;
  struct Slot;
  struct Frame;

  void turnTo(FrameIndex frame, int downscale, const Progress& progress);
  void dropChanged();
  std::size_t fill(const Progress& progress);
  void judge() const;
  LentViews lendPresent(const Wanted& wanted);
  void prefetch(int downscale);
  void decodeAhead(const std::stop_token& stop, Frame& frame);
  void awaitPrefetch(const Progress& progress);
  void dropNext();

  CaptureSet capture_;
  std::shared_ptr<Frame> present_;
  std::shared_ptr<Frame> next_;  // its slots are the thread's until it has ended
  std::optional<FrameIndex> expected_;
  bool given_up_ = false;
  std::uint64_t loans_ = 0;

  mutable std::mutex mutex_;  // over the slots of `next_` and over `idle_`
  std::condition_variable ended_;
  bool idle_ = true;
  std::jthread thread_;
};

}  // namespace beam
