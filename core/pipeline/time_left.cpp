// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/time_left.h"

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

constexpr double kRise = 1.25;        // a guess that much higher is news, less is noise
constexpr double kMemory_s = 20;      // of the pace
constexpr double kLeastPace_s = 0.5;  // before that a pace or a share says nothing
constexpr double kLeastShare = 0.02;
constexpr double kPaceWavers = 1.15;
// How much slower than foreseen this run may be held to be: bounds, and seconds for which the foresight is
// believed, so that a short step says little of long ones.
constexpr double kSlowest = 30, kFastest = 0.1, kBelief_s = 3;

bool isOtherPart(const ProgressReport& last, const ProgressReport& now) {
  return now.label != last.label || now.total != last.total || now.done < last.done;
}

Seconds mixed(const Seconds& a, const Seconds& b, double of_b) {
  Seconds sum = a * (1 - of_b);
  return sum += b * of_b;
}

}  // namespace

// --- StepPace ---

void StepPace::feed(double seconds, const ProgressReport& report) {
  if (!last_ || isOtherPart(*last_, report)) {
    seconds_ = done_ = fraction_ = 0;
  } else {
    const double passed = std::max(0.0, seconds - at_s_), keeps = std::exp(-passed / kMemory_s);
    seconds_ = keeps * seconds_ + passed;
    done_ = keeps * done_ + static_cast<double>(report.done - last_->done);
    fraction_ = keeps * fraction_ + std::max(0.0, report.fraction - last_->fraction);
  }
  last_ = report;
  at_s_ = seconds;
  to_count_ = static_cast<double>(std::max<std::int64_t>(0, report.total - report.done));
}

bool StepPace::tells() const { return seconds_ >= kLeastPace_s && done_ > 0 && fraction_ > 0; }

double StepPace::stepLeft() const { return (1 - last_->fraction) * seconds_ / fraction_; }

// --- TimeLeft ---

void TimeLeft::expect(const StepKind& kind, const StepSize& size) {
  ToDo& to_do = to_do_[kind];
  to_do.size = size;
  ++to_do.count;
}

void TimeLeft::drop(const StepKind& kind) {
  const auto found = to_do_.find(kind);
  if (found != to_do_.end() && --found->second.count <= 0) to_do_.erase(found);
}

void TimeLeft::finish(const StepKind& kind, double seconds) {
  const auto found = to_do_.find(kind);
  const StepSize size = found == to_do_.end() ? StepSize{} : found->second.size;
  if (const auto foreseen = earlier_.ofStep(kind, size.work); foreseen && !here_.knows(kind)) {
    foreseen_s_ += foreseen->likely;
    took_s_ += seconds;
  }
  drop(kind);
  here_.add(kind, size, seconds);
  pace_ = {};
}

// What this run measured itself comes first.
std::optional<Seconds> TimeLeft::guess(const StepKind& kind, const StepSize& size, double slower,
                                       const WeightSum& here) const {
  const bool earlier_first = earlier_.knows(kind) && !here_.knows(kind);
  if (const auto own = here_.ofStep(kind, size.work); own && !earlier_first) return own;
  if (const auto other = earlier_.ofStep(kind, size.work)) return *other * slower;
  if (const auto own = here.guess(size.weight)) return own;
  const auto other = earlier_.byWeight().guess(size.weight);
  return other ? std::optional(*other * slower) : std::nullopt;
}

// Takes the step at work in, by its own pace.
double TimeLeft::slowerWith(const StepKind& now, const StepSize& size, std::optional<double> whole) const {
  double foreseen_s = foreseen_s_ + kBelief_s, took_s = took_s_ + kBelief_s;
  if (const auto foreseen = earlier_.ofStep(now, size.work); foreseen && whole && !here_.knows(now)) {
    foreseen_s += foreseen->likely;
    took_s += *whole;
  }
  return std::clamp(took_s / foreseen_s, kFastest, kSlowest);
}

std::optional<TimeLeft::AtWork> TimeLeft::atWork(const StepKind& now, const StepSize& size, double fraction,
                                                 double seconds) const {
  const std::optional<Seconds> whole = guess(now, size, slowerWith(now, size, {}), here_.byWeight());
  const bool share_tells = fraction > kLeastShare && seconds > kLeastPace_s;
  if (!pace_.tells() && !share_tells) {
    return whole ? std::optional(AtWork{*whole * (1 - fraction), {}}) : std::nullopt;
  }
  const double own_s = pace_.tells() ? pace_.stepLeft() : seconds * (1 - fraction) / fraction;
  Seconds left = around(own_s, 1 + (kOtherSettings - 1) * (1 - fraction));
  // The further the step, and the wider the guess before it, the more its own pace counts.
  if (whole && whole->likely > 0) {
    const double trust = std::pow(fraction, whole->likely / std::max(whole->high, whole->likely));
    left = mixed(*whole * (1 - fraction), left, trust);
  }
  const double counted_s = pace_.countedLeft();
  return AtWork{{std::max(left.low, counted_s / kPaceWavers), std::max(left.likely, counted_s),
                 std::max(left.high, counted_s * kPaceWavers)},
                seconds + own_s};
}

double TimeLeft::told(double likely) {
  const bool noise = told_ && likely > *told_ && likely < *told_ * kRise;
  told_ = std::max(noise ? *told_ : likely, pace_.countedLeft());
  return *told_;
}

std::optional<Seconds> TimeLeft::left(const StepKind& now, const ProgressReport& report,
                                      double seconds_in_step) {
  pace_.feed(seconds_in_step, report);
  const auto found = to_do_.find(now);
  if (found == to_do_.end()) return std::nullopt;
  const StepSize& size = found->second.size;
  const std::optional<AtWork> at_work = atWork(now, size, report.fraction, seconds_in_step);
  if (!at_work) return std::nullopt;
  Seconds sum = at_work->left;
  const double slower = slowerWith(now, size, at_work->whole);
  WeightSum here = here_.byWeight();
  if (at_work->whole && !here_.knows(now)) {
    here.seconds += *at_work->whole;
    here.weight += size.weight;
  }
  for (const auto& [kind, to_do] : to_do_) {
    const int others = to_do.count - (kind == now ? 1 : 0);
    if (others == 0) continue;
    std::optional<Seconds> each = guess(kind, to_do.size, slower, here);
    if (kind == now && at_work->whole && !here_.knows(now)) each = around(*at_work->whole, kOtherSettings);
    if (!each) return std::nullopt;
    sum += *each * others;
  }
  sum.likely = told(sum.likely);
  sum.low = std::min(sum.low, sum.likely);
  sum.high = std::max(sum.high, sum.likely);
  return sum;
}

}  // namespace beam
