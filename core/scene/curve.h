// SPDX-License-Identifier: Apache-2.0
// A number over time by keys. Keys stand beside the values that they drive (scene/look.h), never in them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/fields.h"

namespace beam {

struct CurveKey {
  double time_s = 0;
  double value = 0;
  // From this key to the next: "linear", "smooth" (3u^2 - 2u^3), or "step", which holds the value.
  std::string easing = "linear";
  std::string unknown = "{}";  // members of a later version, kept as they are (a JSON object)

  bool operator==(const CurveKey&) const = default;
};
void describe(Fields& f, CurveKey& key);

struct Curve {
  std::vector<CurveKey> keys;
  std::string unknown = "{}";

  bool operator==(const Curve&) const = default;
};

inline constexpr std::size_t kMostKeys = 100'000;  // of a curve: an hour, a key a frame
inline constexpr double kFarthestTime_s = 1e7;     // from 0, both ways: four months

// At most kMostKeys keys, values finite, times in range and strictly ascending; throws Error{Data} that names
// the first that is not. An easing that this program does not know is no error: it counts as linear.
void validate(const Curve& curve);

// Of a valid curve that has keys. Before the first key and after the last their values hold; at a key it is
// the key's, exactly; between two it stays between their values and goes one way (to rounding).
double valueAt(const Curve& curve, double time_s);
// What cannot lie in between, such as a switch: the value of the last key at or before `time_s`, whatever
// its easing; before the first, the first's.
double heldValueAt(const Curve& curve, double time_s);

}  // namespace beam
