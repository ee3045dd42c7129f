// SPDX-License-Identifier: Apache-2.0
// How long a run still takes, as it goes on: from what was measured before, from its own finished steps, and
// from the pace of the step at work.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/pipeline/step_times.h"

namespace beam {

// How fast the part of a step that is at work counts, lately.
class StepPace {
 public:
  // A report of another part begins anew.
  void feed(double seconds, const ProgressReport& report);
  bool tells() const;
  // Of report.done a second; 0: not known yet.
  double rate() const { return tells() ? done_ / seconds_ : 0; }
  double countedLeft() const { return tells() ? to_count_ * seconds_ / done_ : 0; }  // of the part
  double stepLeft() const;                                                           // of the whole step

 private:
  std::optional<ProgressReport> last_;
  double at_s_ = 0;
  double to_count_ = 0;                           // of the part
  double seconds_ = 0, done_ = 0, fraction_ = 0;  // since it began; what is long ago counts little
};

// The figure falls: a new guess that is higher by less than a quarter does not raise what was told, unless
// the counter of the step at work says that it takes longer.
class TimeLeft {
 public:
  // What was measured before this run.
  void know(const StepTimes& earlier) { earlier_.add(earlier); }
  void expect(const StepKind& kind, const StepSize& size);
  // It was there already, or will not be done.
  void drop(const StepKind& kind);
  void finish(const StepKind& kind, double seconds);
  // The step at work is one of those expected; `report` is of it. Empty: nothing tells yet.
  std::optional<Seconds> left(const StepKind& now, const ProgressReport& report, double seconds_in_step);
  double rate() const { return pace_.rate(); }

 private:
  struct ToDo {
    StepSize size;
    int count = 0;
  };
  // Of the step at work.
  struct AtWork {
    Seconds left;
    std::optional<double> whole;  // by its own pace
  };
  std::optional<Seconds> guess(const StepKind& kind, const StepSize& size, double slower,
                               const WeightSum& here) const;
  std::optional<AtWork> atWork(const StepKind& now, const StepSize& size, double fraction,
                               double seconds) const;
  double slowerWith(const StepKind& now, const StepSize& size, std::optional<double> whole) const;
  double told(double likely);

  StepTimes earlier_, here_;
  std::map<StepKind, ToDo> to_do_;
  StepPace pace_;
  double foreseen_s_ = 0, took_s_ = 0;  // finished steps that were foreseen from earlier times
  std::optional<double> told_;
};

}  // namespace beam
