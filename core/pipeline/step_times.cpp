// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/step_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/math/statistics.h"
#include "core/pipeline/project.h"

namespace beam {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kKept = 64;       // of a kind
constexpr double kLeastSpread = 1.15;   // two equal measurements do not make a third
constexpr double kOtherSettings = 2.0;  // either way: iterations and sizes differ by about as much
constexpr double kByWeight = 2.5;       // likewise of steps that were never measured
constexpr double kRise = 1.25;          // a guess that much higher is news, less is noise

Seconds around(double likely, double factor) { return {likely / factor, likely, likely * factor}; }

// Early in a step its own pace says little.
bool paceTells(double fraction, double seconds) { return fraction > 0.02 && seconds > 0.5; }

}  // namespace

Digest settingsDigest(const std::map<std::string, std::string>& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) text += fmt::format("{}={}\n", name, value);
  return digestOf(text);
}

StepKind kindOf(const KeyIngredients& made) {
  return {made.step, made.later, settingsDigest(made.parameters)};
}

Seconds& Seconds::operator+=(const Seconds& other) {
  low += other.low, likely += other.likely, high += other.high;
  return *this;
}

Seconds operator*(const Seconds& s, double factor) {
  return {s.low * factor, s.likely * factor, s.high * factor};
}

// --- StepTimes ---

void StepTimes::add(const StepKind& kind, double weight, double seconds) {
  Measured& m = measured_[kind];
  m.weight = weight;
  m.seconds.push_back(seconds);
  if (m.seconds.size() > kKept) m.seconds.erase(m.seconds.begin());
}

void StepTimes::add(const StepTimes& others) {
  for (const auto& [kind, m] : others.measured_) {
    for (const double s : m.seconds) add(kind, m.weight, s);
  }
}

std::optional<Seconds> StepTimes::ofKind(const StepKind& kind) const {
  const auto found = measured_.find(kind);
  if (found == measured_.end()) return std::nullopt;
  const std::vector<double>& all = found->second.seconds;
  const double likely = median(all);
  return Seconds{std::min(quantile(all, 0.25), likely / kLeastSpread), likely,
                 std::max(quantile(all, 0.75), likely * kLeastSpread)};
}

std::optional<Seconds> StepTimes::ofStepIn(const std::string& step, bool later) const {
  std::vector<double> all;
  for (const auto& [kind, m] : measured_) {
    if (kind.step == step && kind.later == later) all.push_back(median(m.seconds));
  }
  return all.empty() ? std::nullopt : std::optional(around(median(all), kOtherSettings));
}

std::optional<Seconds> StepTimes::ofStep(const StepKind& kind) const {
  const std::optional<Seconds> same = ofStepIn(kind.step, kind.later);
  return same ? same : ofStepIn(kind.step, !kind.later);
}

std::optional<double> StepTimes::secondsPerWeight() const {
  double seconds = 0, weight = 0;
  for (const auto& [kind, m] : measured_) {
    seconds += median(m.seconds);
    weight += m.weight;
  }
  return weight > 0 ? std::optional(seconds / weight) : std::nullopt;
}

std::optional<Seconds> StepTimes::guess(const StepKind& kind, double weight) const {
  if (const auto exact = ofKind(kind)) return exact;
  if (const auto other = ofStep(kind)) return other;
  const std::optional<double> pace = secondsPerWeight();
  return pace ? std::optional(around(weight * *pace, kByWeight)) : std::nullopt;
}

std::string toJson(const StepTimes& times) {
  Json j = Json::array();
  for (const auto& [kind, m] : times.measured_) {
    j.push_back({{"step", kind.step},
                 {"later", kind.later},
                 {"settings", kind.settings.hex()},
                 {"weight", m.weight},
                 {"seconds", m.seconds}});
  }
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

StepTimes parseStepTimes(std::string_view json) {
  try {
    StepTimes times;
    for (const Json& j : Json::parse(json)) {
      const StepKind kind{j.at("step").get<std::string>(), j.at("later").get<bool>(),
                          parseDigest(j.at("settings").get<std::string>())};
      for (const Json& seconds : j.at("seconds"))
        times.add(kind, j.at("weight").get<double>(), seconds.get<double>());
    }
    return times;
  } catch (const nlohmann::json::exception&) {
    throw Error(Error::Kind::Data,
                "the measured times of steps cannot be understood: expected a list of steps with seconds");
  }
}

StepTimes readStepTimes(const Project& project) {
  std::map<std::string, double> weights;
  for (const StageInfo& info : project.setup().stages.infos()) {
    for (const StepInfo& step : info.steps) weights[info.id + "." + step.id] = step.weight;
  }
  StepTimes times;
  for (const Digest& key : project.store().keys()) {
    const std::optional<ResultRecord> record = project.store().record(key);
    if (!record) continue;
    if (const auto weight = weights.find(record->ingredients.step); weight != weights.end())
      times.add(kindOf(record->ingredients), weight->second, record->seconds);
  }
  return times;
}

// --- TimeLeft ---

void TimeLeft::expect(const StepKind& kind, double weight) {
  ToDo& to_do = to_do_[kind];
  to_do.weight = weight;
  ++to_do.count;
}

void TimeLeft::drop(const StepKind& kind) {
  const auto found = to_do_.find(kind);
  if (found != to_do_.end() && --found->second.count <= 0) to_do_.erase(found);
}

void TimeLeft::finish(const StepKind& kind, double weight, double seconds) {
  drop(kind);
  here_.add(kind, weight, seconds);
}

// What this run measured itself comes first; `pace`: seconds of weight 1 in the step at work.
std::optional<Seconds> TimeLeft::guess(const StepKind& kind, double weight,
                                       std::optional<double> pace) const {
  if (const auto own = here_.ofKind(kind)) return own;
  if (const auto exact = earlier_.ofKind(kind)) return exact;
  if (const auto own = here_.ofStep(kind)) return own;
  if (const auto other = earlier_.ofStep(kind)) return other;
  if (const auto measured = here_.secondsPerWeight()) pace = measured;
  if (const auto measured = earlier_.secondsPerWeight(); measured && !pace) pace = measured;
  return pace ? std::optional(around(weight * *pace, kByWeight)) : std::nullopt;
}

std::optional<Seconds> TimeLeft::left(const StepKind& now, double fraction, double seconds_in_step) {
  const auto at_work = to_do_.find(now);
  if (at_work == to_do_.end()) return std::nullopt;
  const double weight = at_work->second.weight;
  std::optional<double> pace;
  std::optional<Seconds> whole = guess(now, weight, pace);
  if (paceTells(fraction, seconds_in_step)) {
    const double projected = seconds_in_step / fraction;
    if (weight > 0) pace = projected / weight;
    // The further the step, the more its own pace counts.
    Seconds own = around(projected, 1 + (kOtherSettings - 1) * (1 - fraction));
    if (whole) {
      own = own * fraction;
      own += *whole * (1 - fraction);
    }
    whole = own;
  }
  if (!whole) return std::nullopt;
  Seconds sum = *whole * (1 - fraction);
  for (const auto& [kind, to_do] : to_do_) {
    const int others = to_do.count - (kind == now ? 1 : 0);
    if (others == 0) continue;
    const std::optional<Seconds> each = guess(kind, to_do.weight, pace);
    if (!each) return std::nullopt;
    sum += *each * others;
  }
  const bool noise = told_ && sum.likely > *told_ && sum.likely < *told_ * kRise;
  if (noise) sum.likely = *told_;
  sum.low = std::min(sum.low, sum.likely);
  told_ = sum.likely;
  return sum;
}

}  // namespace beam
