// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/step_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/math/statistics.h"
#include "core/pipeline/project.h"

namespace beam {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kKept = 64;  // of a kind
// Factors to either side of a guess.
constexpr double kLeastSpread = 1.15;  // two equal measurements do not make a third
constexpr double kOtherFrames = 2.5;   // first frames for later ones, or the reverse
constexpr double kFar = 3;             // the work differs much, or it was another step
constexpr double kUnknownWork = 4;
constexpr double kAlike = 1.1;        // so much more doubt is no worse
constexpr double kMuchLighter = 0.1;  // of the weight

// Time follows most of what StepInfo::work counts, not all (Gaussians, masks, caches): half of a difference,
// as a power, is in doubt.
double doubtOfWork(double measured, double wanted) {
  if (measured <= 0 || wanted <= 0) return kUnknownWork;
  const double ratio = std::max(measured, wanted) / std::min(measured, wanted);
  return std::min(kFar, kLeastSpread * std::sqrt(ratio));
}

double doubtOf(const StepKind& measured, double its_work, const StepKind& wanted, double work) {
  double doubt = doubtOfWork(its_work, work);
  if (measured.settings != wanted.settings) doubt = std::max(doubt, kOtherSettings);
  if (measured.later != wanted.later) doubt = std::max(doubt, kOtherFrames);
  return doubt;
}

struct Told {
  double seconds, doubt;
};

std::optional<Seconds> leastDoubted(const std::vector<Told>& all) {
  double least = std::numeric_limits<double>::infinity();
  for (const Told& told : all) least = std::min(least, told.doubt);
  std::vector<double> best;
  for (const Told& told : all) {
    if (told.doubt <= kAlike * least) best.push_back(told.seconds);
  }
  if (best.empty()) return std::nullopt;
  const double likely = median(best);
  return Seconds{std::min(quantile(best, 0.25), likely / least), likely,
                 std::max(quantile(best, 0.75), likely * least)};
}

}  // namespace

Digest settingsDigest(const std::map<std::string, std::string>& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) text += fmt::format("{}={}\n", name, value);
  return digestOf(text);
}

StepKind kindOf(const KeyIngredients& made) {
  return {made.step, made.later, settingsDigest(made.parameters)};
}

StepSize sizeOf(const Project& project, const StepId& step, bool later) {
  return {project.setup().stages.step(step).weight, project.workOf(step, later)};
}

Seconds& Seconds::operator+=(const Seconds& other) {
  low += other.low, likely += other.likely, high += other.high;
  return *this;
}

Seconds operator*(const Seconds& s, double factor) {
  return {s.low * factor, s.likely * factor, s.high * factor};
}

Seconds around(double likely, double factor) { return {likely / factor, likely, likely * factor}; }

std::optional<Seconds> WeightSum::guess(double of_weight) const {
  if (weight <= 0 || weight < kMuchLighter * of_weight) return std::nullopt;
  return around(of_weight * seconds / weight, kFar);
}

// --- StepTimes ---

void StepTimes::add(const StepKind& kind, const StepSize& size, double seconds) {
  Measured& m = measured_[kind];
  m.weight = size.weight;
  m.seconds.push_back(seconds);
  m.works.push_back(size.work);
  if (m.seconds.size() <= kKept) return;
  m.seconds.erase(m.seconds.begin());
  m.works.erase(m.works.begin());
}

void StepTimes::add(const StepTimes& others) {
  for (const auto& [kind, m] : others.measured_) {
    for (std::size_t i = 0; i < m.seconds.size(); ++i) add(kind, {m.weight, m.works[i]}, m.seconds[i]);
  }
}

std::optional<Seconds> StepTimes::ofStep(const StepKind& kind, double work) const {
  std::vector<Told> all;
  for (const auto& [measured, m] : measured_) {
    if (measured.step != kind.step) continue;
    for (std::size_t i = 0; i < m.seconds.size(); ++i) {
      const double scale = m.works[i] > 0 && work > 0 ? work / m.works[i] : 1;
      all.push_back({scale * m.seconds[i], doubtOf(measured, m.works[i], kind, work)});
    }
  }
  return leastDoubted(all);
}

WeightSum StepTimes::byWeight() const {
  WeightSum sum;
  for (const auto& [kind, m] : measured_) {
    sum.seconds += median(m.seconds);
    sum.weight += m.weight;
  }
  return sum;
}

std::optional<Seconds> StepTimes::guess(const StepKind& kind, const StepSize& size) const {
  const std::optional<Seconds> same = ofStep(kind, size.work);
  return same ? same : byWeight().guess(size.weight);
}

std::string toJson(const StepTimes& times) {
  Json j = Json::array();
  for (const auto& [kind, m] : times.measured_) {
    j.push_back({{"step", kind.step.text()},
                 {"later", kind.later},
                 {"settings", kind.settings.hex()},
                 {"weight", m.weight},
                 {"seconds", m.seconds},
                 {"works", m.works}});
  }
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

StepTimes parseStepTimes(std::string_view json) {
  try {
    StepTimes times;
    for (const Json& j : Json::parse(json)) {
      const StepKind kind{StepId(j.at("step").get<std::string>()), j.at("later").get<bool>(),
                          parseDigest(j.at("settings").get<std::string>())};
      const auto seconds = j.at("seconds").get<std::vector<double>>();
      auto works = j.value("works", std::vector<double>());
      works.resize(seconds.size(), 0);
      for (std::size_t i = 0; i < seconds.size(); ++i)
        times.add(kind, {j.at("weight").get<double>(), works[i]}, seconds[i]);
    }
    return times;
  } catch (const nlohmann::json::exception&) {
    throw Error(Error::Kind::Data,
                "the measured times of steps cannot be understood: expected a list of steps with seconds");
  }
}

StepTimes readStepTimes(const Project& project) {
  std::map<StepId, double> weights;
  for (const StageInfo& info : project.setup().stages.infos()) {
    for (const StepInfo& step : info.steps) weights[StepId(info.id, step.id)] = step.weight;
  }
  StepTimes times;
  for (const Digest& key : project.store().keys()) {
    const std::optional<ResultRecord> record = project.store().record(key);
    if (!record) continue;
    if (const auto weight = weights.find(record->ingredients.step); weight != weights.end())
      times.add(kindOf(record->ingredients), {weight->second, record->work}, record->seconds);
  }
  return times;
}

}  // namespace beam
