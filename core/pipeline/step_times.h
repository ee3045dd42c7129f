// SPDX-License-Identifier: Apache-2.0
// How long steps took, from records and from runs here, and what follows for steps of other sizes. A hint for
// people: nothing that is computed depends on it.
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

// Steps that should take equally long for equal work: first frames of takes and later ones are different.
struct StepKind {
  StepId step;
  bool later = false;
  Digest settings;  // of the step's own parameters
  auto operator<=>(const StepKind&) const = default;
};
StepKind kindOf(const KeyIngredients& made);
Digest settingsDigest(const std::map<std::string, std::string>& parameters);

// What is known of a step's time before one was ever timed.
struct StepSize {
  double weight = 1;  // StepInfo::weight: compares steps
  double work = 1;    // Project::workOf: compares captures and settings; 0: not known
};
StepSize sizeOf(const Project& project, const StepId& step, bool later);

struct Seconds {
  double low = 0, likely = 0, high = 0;
  Seconds& operator+=(const Seconds& other);
};
Seconds operator*(const Seconds& seconds, double factor);
// `factor` to either side.
Seconds around(double likely, double factor);

constexpr double kOtherSettings = 2;  // iterations and sizes differ by about as much, either way

// All steps of a kind taken once.
struct WeightSum {
  double seconds = 0, weight = 0;
  // Of a step of that weight; empty where all that was timed is much lighter: an import tells nothing of a
  // fit.
  std::optional<Seconds> guess(double of_weight) const;
};

class StepTimes {
 public:
  void add(const StepKind& kind, const StepSize& size, double seconds);
  void add(const StepTimes& others);
  bool empty() const { return measured_.empty(); }
  // From what was measured of the step with the most alike settings and work, in proportion to the work; the
  // range says how much that is to be doubted. With settings and work alike, half of what was measured lies
  // between low and high.
  std::optional<Seconds> ofStep(const StepKind& kind, double work) const;
  bool knows(const StepKind& kind) const { return measured_.contains(kind); }
  WeightSum byWeight() const;
  // The best of these; empty: nothing that was measured tells.
  std::optional<Seconds> guess(const StepKind& kind, const StepSize& size) const;

  friend std::string toJson(const StepTimes& times);
  friend StepTimes parseStepTimes(std::string_view json);

 private:
  struct Measured {
    double weight = 0;
    std::vector<double> seconds, works;  // the newest last, so many at most
  };
  std::map<StepKind, Measured> measured_;
};
// Throws Error{Data}. Times without the work they were for, from versions that did not keep it, are read.
StepTimes parseStepTimes(std::string_view json);

// What the records in results/ say, of any settings.
StepTimes readStepTimes(const Project& project);

}  // namespace beam
