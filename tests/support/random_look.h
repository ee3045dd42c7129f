// SPDX-License-Identifier: Apache-2.0
// Looks with something in every field, for laws that hold for any: a light of each kind, one of a later
// version, curves, and members of a later version at every level.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/base/rng.h"
#include "core/scene/look.h"

namespace beam::testing {

// Gives every field another value that is in its range.
class FillFields final : public Fields {
 public:
  explicit FillFields(std::uint64_t seed) : random_(seed) {}

  double number(double low, double high) {
    const double u = static_cast<double>(random_.bits(next_++) >> 11) * 0x1p-53;
    return low + u * (high - low);
  }

 protected:
  void visit(const FieldInfo& info, FieldPointer target) override {
    if (bool* const* on = std::get_if<bool*>(&target)) **on = !**on;
    if (int* const* count = std::get_if<int*>(&target)) ++**count;
    if (double* const* value = std::get_if<double*>(&target)) {
      const double low = std::max(info.min, -1e6), high = std::min(info.max, 1e6);
      // Half of them of the size that people use.
      **value =
          random_.below(next_++, 2) ? number(low, high) : number(std::max(low, -2.0), std::min(high, 2.0));
    }
    if (std::string* const* text = std::get_if<std::string*>(&target)) **text = word(info, **text);
  }

 private:
  std::string word(const FieldInfo& info, const std::string& now) {
    if (info.choices.empty()) return now + "\"\\ \n\xc3\xa9.\xe2\x82\xac" + std::to_string(next_++);
    const auto at = std::find(info.choices.begin(), info.choices.end(), now) - info.choices.begin();
    return info.choices[(static_cast<std::size_t>(at) + 1) % info.choices.size()];
  }

  RandomStream random_;
  std::uint64_t next_ = 0;
};

template <class T>
T filled(T value, std::uint64_t seed) {
  FillFields fill(seed);
  describe(fill, value);
  return value;
}

// A value that the field may have and has not.
inline FieldValue otherValue(const Field& field) {
  FieldValue value = field.value;
  if (bool* on = std::get_if<bool>(&value)) *on = !*on;
  if (int* count = std::get_if<int>(&value)) *count += *count < field.info.max ? 1 : -1;
  if (double* number = std::get_if<double>(&value))
    *number = std::nextafter(*number, *number < field.info.max ? field.info.max : field.info.min);
  if (std::string* word = std::get_if<std::string>(&value)) {
    const auto& choices = field.info.choices;
    const auto other =
        std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c != *word; });
    *word = other == choices.end() ? *word + "!" : *other;
  }
  return value;
}

// Calls check(name, changed) with the least change of each field that `value` describes, one at a time.
template <class T, class Check>
void changeEachField(const T& value, Check&& check) {
  for (const Field& field : fieldsOf(value)) {
    T changed = value;
    FieldSetter setter(field.info.name, otherValue(field));
    describe(setter, changed);
    check(field.info.name, changed);
  }
}

inline Curve randomCurve(const FieldInfo& info, bool is_switch, FillFields& random) {
  Curve curve;
  double time_s = random.number(-3, 0);
  for (int i = 0; i < 5; ++i) {
    time_s += random.number(0.01, 2);
    const double value = is_switch ? i % 2 : random.number(std::max(info.min, -1e3), std::min(info.max, 1e3));
    curve.keys.push_back({time_s, value, std::vector<std::string>{"linear", "smooth", "step"}[i % 3]});
  }
  return curve;
}

// What a later version added is in the form that reading gives it: members sorted, no blanks.
inline Look randomLook(std::uint64_t seed) {
  Look look;
  look.name = "Look " + std::to_string(seed);
  for (const std::string& kind : lightKinds()) look.lighting.lights.push_back(newLight(kind + "_1", kind));
  look.lighting.lights.push_back(newLight("later", "portal"));
  look = filled(look, seed);
  look.lighting.lights.back().unknown = R"({"portal":{"depth":[1,2.5,null]},"width":3})";
  look.lighting.lights.front().unknown = R"({"color":{"profile":"P3"},"halo":true})";
  look.lighting.environment.unknown = R"({"blur":0.25,"file":{"digest":"ab"}})";
  look.background.unknown = R"({"plate":{"frame":7}})";
  look.camera_path.unknown = R"({"ease":"in"})";
  look.unknown = R"({"grain":{"size":0.001},"notes":["a","b"]})";
  FillFields random(seed + 1000);
  for (const Field& field : fieldsOf(look)) {
    const bool is_switch = std::holds_alternative<bool>(field.value);
    if (is_switch || std::holds_alternative<double>(field.value))
      look.curves[field.info.name] = randomCurve(field.info, is_switch, random);
  }
  look.curves["lights.later.portal.depth"] = look.curves["exposure_stops"];
  look.curves["exposure_stops"].keys[1].unknown = R"({"tangent":[0,1]})";
  look.curves["exposure_stops"].unknown = R"({"after":"loop"})";
  return look;
}

}  // namespace beam::testing
