// SPDX-License-Identifier: Apache-2.0
#include "core/scene/curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace beam {
namespace {

// The first key after `time_s`.
auto keyAfter(const Curve& curve, double time_s) {
  return std::upper_bound(curve.keys.begin(), curve.keys.end(), time_s,
                          [](double time, const CurveKey& key) { return time < key.time_s; });
}

double eased(const std::string& easing, double u) {
  if (easing == "step") return 0;
  return easing == "smooth" ? std::min(u * u * (3 - 2 * u), 1.0) : u;
}

}  // namespace

void describe(Fields& f, CurveKey& key) {
  f.field({.name = "time_s",
           .label = "Time",
           .help = "From the start of the scene.",
           .min = -kFarthestTime_s,
           .max = kFarthestTime_s,
           .unit = "s"},
          key.time_s);
  f.field({.name = "value", .label = "Value", .help = "In the unit of the field that it drives."}, key.value);
  f.field({.name = "easing",
           .label = "Easing",
           .help = "How the value goes from this key to the next.",
           .choices = {"linear", "smooth", "step"}},
          key.easing);
}

void validate(const Curve& curve) {
  if (curve.keys.size() > kMostKeys) {
    throw Error(Error::Kind::Data,
                fmt::format("keys: expected at most {}, found {}", kMostKeys, curve.keys.size()));
  }
  for (std::size_t i = 0; i < curve.keys.size(); ++i) {
    const CurveKey& key = curve.keys[i];
    if (!(std::abs(key.time_s) <= kFarthestTime_s) || !std::isfinite(key.value)) {
      throw Error(
          Error::Kind::Data,
          fmt::format("keys[{}]: expected a time from {} to {} s and a finite value, found {} s and {}", i,
                      -kFarthestTime_s, kFarthestTime_s, key.time_s, key.value));
    }
    if (i > 0 && key.time_s <= curve.keys[i - 1].time_s) {
      throw Error(Error::Kind::Data, fmt::format("keys[{}]: expected a time after {} s, found {} s", i,
                                                 curve.keys[i - 1].time_s, key.time_s));
    }
  }
}

double valueAt(const Curve& curve, double time_s) {
  const auto next = keyAfter(curve, time_s);
  if (next == curve.keys.begin()) return next->value;
  const CurveKey& key = *(next - 1);
  if (next == curve.keys.end()) return key.value;
  const double u = (time_s - key.time_s) / (next->time_s - key.time_s);
  return std::lerp(key.value, next->value, eased(key.easing, u));
}

double heldValueAt(const Curve& curve, double time_s) {
  const auto next = keyAfter(curve, time_s);
  return next == curve.keys.begin() ? next->value : (next - 1)->value;
}

}  // namespace beam
