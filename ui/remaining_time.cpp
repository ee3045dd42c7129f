// SPDX-License-Identifier: Apache-2.0
#include "ui/remaining_time.h"

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

constexpr double kPatience_s = 5;  // so long estimates stay outside before the range follows them
// Of what is left, to either side: at the start of a run and at its end.
constexpr double kWidest = 0.6, kNarrowest = 0.15;
constexpr double kMinute_s = 60, kHour_s = 3600;

// A grain that a person would use for so long a time.
double grainOf(double high_s) {
  if (high_s <= 10 * kMinute_s) return kMinute_s;
  if (high_s <= kHour_s) return 5 * kMinute_s;
  if (high_s <= 6 * kHour_s) return 0.5 * kHour_s;
  return kHour_s;
}

}  // namespace

void RemainingTime::start() { *this = {}; }

double RemainingTime::low_s() const { return std::max(0.0, low_end_s_ - elapsed_s_); }
double RemainingTime::high_s() const { return std::max(0.0, high_end_s_ - elapsed_s_); }

void RemainingTime::adopt(double low_end_s, double high_end_s) {
  low_end_s_ = low_end_s;
  high_end_s_ = high_end_s;
  outside_since_s_ = -1;
  known_ = true;
}

void RemainingTime::feed(double elapsed_s, double left_s, double job_fraction, const TimeBounds& bounds) {
  elapsed_s_ = std::max(elapsed_s_, elapsed_s);
  if (left_s < 0) return;
  const double spread = kWidest + (kNarrowest - kWidest) * std::sqrt(std::clamp(job_fraction, 0.0, 1.0));
  const double end_s = elapsed_s_ + left_s;
  double low_s = (1 - spread) * left_s;
  if (bounds.low_s >= 0) low_s = std::min(low_s, bounds.low_s);
  const double low_end_s = elapsed_s_ + std::min(std::max(low_s, bounds.least_s), left_s);
  const double high_end_s = elapsed_s_ + std::max({(1 + spread) * left_s, bounds.high_s, bounds.least_s});
  if (!known_) return adopt(low_end_s, high_end_s);
  // Wider at once, with room: it must not happen again soon.
  if (elapsed_s_ + bounds.least_s > high_end_s_) return adopt(std::max(low_end_s_, elapsed_s_), high_end_s);
  if (end_s < low_end_s_ || end_s > high_end_s_) {
    if (outside_since_s_ < 0) outside_since_s_ = elapsed_s_;
    if (elapsed_s_ - outside_since_s_ >= kPatience_s) adopt(low_end_s, high_end_s);
    return;
  }
  outside_since_s_ = -1;
  // Narrower by what both agree on; the estimate stays in it.
  low_end_s_ = std::max(low_end_s_, low_end_s);
  high_end_s_ = std::min(high_end_s_, high_end_s);
}

QString RemainingTime::text() const {
  if (!known_) return "estimating the time";
  if (high_s() < kMinute_s) return "less than a minute left";
  return rangeText(low_s(), high_s()) + " left";
}

QString rangeText(double low_s, double high_s) {
  const double grain = grainOf(high_s);
  const bool hours = high_s > kHour_s;
  const double unit = hours ? kHour_s : kMinute_s;
  // A hair of slack: 300.0000001 s are five minutes.
  const double low = std::floor(low_s / grain + 1e-6) * grain / unit;
  const double high = std::max(1.0, std::ceil(high_s / grain - 1e-6)) * grain / unit;
  const QString name = hours ? "h" : "min";
  const auto number = [](double value) { return QString::number(value, 'g', 4); };
  if (low <= 0) return QString("up to %1 %2").arg(number(high), name);
  if (low >= high) return QString("about %1 %2").arg(number(high), name);
  return QString("%1 to %2 %3").arg(number(low), number(high), name);
}

}  // namespace beam
