// SPDX-License-Identifier: Apache-2.0
// The time that a run still takes, in words a person can plan with: a range whose upper end falls. Estimates
// jump where a step is slower than its share; the range is wide enough for that at first and gets narrower as
// the run goes on, and rises only when the estimates stay outside of it or a counter says more.
#pragma once

#include <QString>

namespace beam {

// What is known beside the likeliest figure, in seconds left.
struct TimeBounds {
  double low_s = -1, high_s = -1;  // between these it is likely to be; < 0: not known
  double least_s = 0;              // what a counter beside it says: the upper end is never below
};

class RemainingTime {
 public:
  void start();
  // Seconds since the start of the run, estimated seconds left (below 0: not known), share of the run that is
  // done. Elapsed seconds never fall between two starts.
  void feed(double elapsed_s, double left_s, double job_fraction, const TimeBounds& bounds = {});

  bool known() const { return known_; }
  double low_s() const;   // seconds left from the newest feed on, at least 0
  double high_s() const;  // likewise; never less than low_s()
  // "3 to 5 min left", "up to 2 min left", "less than a minute left", "estimating the time".
  QString text() const;

 private:
  void adopt(double low_end_s, double high_end_s);

  bool known_ = false;
  double elapsed_s_ = 0;
  double low_end_s_ = 0, high_end_s_ = 0;  // ends of the run, on the clock of `elapsed_s`
  double outside_since_s_ = -1;            // < 0: the newest estimate lies in the range
};

// "3 to 5 min", "about 2 h": rounded outward, coarser the longer it is.
QString rangeText(double low_s, double high_s);

}  // namespace beam
