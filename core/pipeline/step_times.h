// SPDX-License-Identifier: Apache-2.0
// How long steps took, from records and from a run at work, and what follows for those that are to come. A
// hint for people: nothing that is computed depends on it.
#pragma once

#include <compare>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/hash.h"
#include "core/pipeline/result_key.h"

namespace beam {

class Project;

// Steps that should take equally long: first frames of takes and later ones are different work.
struct StepKind {
  std::string step;  // full id
  bool later = false;
  Digest settings;  // of the step's own parameters
  auto operator<=>(const StepKind&) const = default;
};
StepKind kindOf(const KeyIngredients& made);
Digest settingsDigest(const std::map<std::string, std::string>& parameters);

struct Seconds {
  double low = 0, likely = 0, high = 0;
  Seconds& operator+=(const Seconds& other);
};
Seconds operator*(const Seconds& seconds, double factor);

class StepTimes {
 public:
  // `weight`: StepInfo::weight.
  void add(const StepKind& kind, double weight, double seconds);
  void add(const StepTimes& others);
  bool empty() const { return measured_.empty(); }
  // Half of what was measured lies between low and high.
  std::optional<Seconds> ofKind(const StepKind& kind) const;
  // Of the step with any settings, of the other kind of frame when there is no better: a guess with a wide
  // range.
  std::optional<Seconds> ofStep(const StepKind& kind) const;
  // Seconds that a step of weight 1 takes, from all that was measured.
  std::optional<double> secondsPerWeight() const;
  // The best of these; empty: nothing was measured.
  std::optional<Seconds> guess(const StepKind& kind, double weight) const;

  friend std::string toJson(const StepTimes& times);
  friend StepTimes parseStepTimes(std::string_view json);

 private:
  struct Measured {
    double weight = 0;
    std::vector<double> seconds;  // the newest last, so many at most
  };
  std::optional<Seconds> ofStepIn(const std::string& step, bool later) const;
  std::map<StepKind, Measured> measured_;
};
// Throws Error{Data}.
StepTimes parseStepTimes(std::string_view json);

// What the records in results/ say, of any settings.
StepTimes readStepTimes(const Project& project);

// Seconds that a run still takes, as it goes on. The figure falls: a new guess that is higher by less than a
// quarter does not raise what was told.
class TimeLeft {
 public:
  // What was measured before this run.
  void know(const StepTimes& earlier) { earlier_.add(earlier); }
  void expect(const StepKind& kind, double weight);
  // It was there already, or will not be done.
  void drop(const StepKind& kind);
  void finish(const StepKind& kind, double weight, double seconds);
  // The step at work is one of those expected. Empty: nothing tells yet.
  std::optional<Seconds> left(const StepKind& now, double fraction, double seconds_in_step);

 private:
  struct ToDo {
    double weight = 0;
    int count = 0;
  };
  std::optional<Seconds> guess(const StepKind& kind, double weight, std::optional<double> pace) const;

  StepTimes earlier_, here_;
  std::map<StepKind, ToDo> to_do_;
  std::optional<double> told_;
};

}  // namespace beam
