// SPDX-License-Identifier: Apache-2.0
#include "viewers/playback_clock.h"

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

constexpr double kRateWindow_s = 2;
constexpr double kDrawingShare = 0.85;  // of the interval; the rest is for upload and composition
constexpr double kTickSlack = 1e-6;     // a tick that is due "now" is due in spite of rounding

}  // namespace

void PlaybackClock::setTake(int frames, double frames_per_second) {
  frames_ = std::max(frames, 0);
  fps_ = frames_per_second > 0 ? frames_per_second : 30;
  playing_ = false;
  clearRange();
}

void PlaybackClock::setIn(int frame) {
  range_.first = std::clamp(frame, 0, std::max(frames_ - 1, 0));
  if (range_.first > range_.last) range_.last = frames_ - 1;
}

void PlaybackClock::setOut(int frame) {
  range_.last = std::clamp(frame, 0, std::max(frames_ - 1, 0));
  if (range_.last < range_.first) range_.first = 0;
}

void PlaybackClock::clearRange() { range_ = {0, frames_ - 1}; }

void PlaybackClock::start(int frame, double now_s) {
  if (range_.size() < 1) return;
  start_frame_ = range_.contains(frame) && (loop_ || frame < range_.last) ? frame : range_.first;
  start_s_ = now_s;
  playing_ = true;
  due_tick_ = 0;
  shown_tick_ = -1;
  shown_s_.clear();
  dropped_ = 0;
}

int PlaybackClock::frameAt(double now_s) {
  if (!range_.contains(start_frame_)) start_frame_ = range_.first;  // the range was changed meanwhile
  due_tick_ = std::max(0LL, static_cast<long long>(std::floor((now_s - start_s_) * fps_ + kTickSlack)));
  const long long along = start_frame_ - range_.first + due_tick_;
  if (loop_) return range_.first + static_cast<int>(along % range_.size());
  if (along >= range_.size()) playing_ = false;
  return range_.first + static_cast<int>(std::min<long long>(along, range_.size() - 1));
}

void PlaybackClock::shown(double now_s) {
  if (due_tick_ <= shown_tick_) return;
  dropped_ += static_cast<int>(due_tick_ - shown_tick_ - 1);
  shown_tick_ = due_tick_;
  shown_s_.push_back(now_s);
  while (shown_s_.front() < now_s - kRateWindow_s) shown_s_.pop_front();
}

double PlaybackClock::rate() const {
  if (shown_s_.size() < 3 || shown_s_.back() <= shown_s_.front()) return 0;
  return static_cast<double>(shown_s_.size() - 1) / (shown_s_.back() - shown_s_.front());
}

int playDivisor(double full_ms, double half_ms, double interval_ms) {
  const double most_ms = kDrawingShare * interval_ms;
  if (full_ms <= most_ms) return 1;
  return half_ms <= most_ms ? 2 : 4;
}

}  // namespace beam
