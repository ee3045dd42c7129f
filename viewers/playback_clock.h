// SPDX-License-Identifier: Apache-2.0
// Which frame of a take is due when: plays between an in and an out point at the take's rate, leaves out
// frames that come too late rather than slowing down, and says the rate that is reached. Times are given, not
// read, in seconds of any steady clock.
#pragma once

#include <deque>

namespace beam {

// Both ends belong to it.
struct FrameRange {
  int first = 0, last = 0;
  int size() const { return last - first + 1; }
  bool contains(int frame) const { return frame >= first && frame <= last; }
  bool operator==(const FrameRange&) const = default;
};

class PlaybackClock {
 public:
  // The whole take becomes the range; play stops.
  void setTake(int frames, double frames_per_second);
  int frames() const { return frames_; }
  double takeRate() const { return fps_; }

  // Clamped into the take. A point beyond the other one takes the other back to its end of the take.
  void setIn(int frame);
  void setOut(int frame);
  void clearRange();
  FrameRange range() const { return range_; }
  bool wholeTake() const { return range_ == FrameRange{0, frames_ - 1}; }

  void setLoop(bool loop) { loop_ = loop; }
  bool loop() const { return loop_; }

  // From `frame`, or from the in point when it lies outside of the range or at its end.
  void start(int frame, double now_s);
  void stop() { playing_ = false; }
  bool playing() const { return playing_; }
  // The frame that is due; without a loop play stops after the out point.
  int frameAt(double now_s);
  // The frame that frameAt gave last is on the screen.
  void shown(double now_s);
  // Frames a second that came to the screen lately; 0: too few to say.
  double rate() const;
  int dropped() const { return dropped_; }  // since the start

 private:
  int frames_ = 0;
  double fps_ = 30;
  FrameRange range_{0, -1};
  bool loop_ = true, playing_ = false;
  double start_s_ = 0;
  int start_frame_ = 0;
  long long due_tick_ = 0, shown_tick_ = -1;
  std::deque<double> shown_s_;  // of the last kRateWindow_s
  int dropped_ = 0;
};

// Full, half or quarter size: the largest whose pictures keep up with `interval_ms`, told from how long those
// of full and of half size take.
int playDivisor(double full_ms, double half_ms, double interval_ms);

}  // namespace beam
