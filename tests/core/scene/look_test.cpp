// SPDX-License-Identifier: Apache-2.0
#include "core/scene/look.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/random_look.h"

namespace beam {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::filled;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::messageOf;
using testing::randomLook;

std::string refusal(const Look& look) {
  return messageOf(Error::Kind::Data, [&] { validate(look); });
}

Look lookWithKeyLight() {
  Look look;
  look.lighting.lights.push_back(newLight("key", "spot"));
  return look;
}

// --- Curves ---

Curve someCurve(const std::string& easing) {
  return {{{-1, 2, easing}, {0.5, -3, easing}, {0.6, -3, easing}, {4, 1e6, easing}}};
}

TEST(Curve, GivesTheValueOfAKeyAtItsTimeAndHoldsTheOutermost) {
  for (const char* easing : {"linear", "smooth", "step"}) {
    const Curve curve = someCurve(easing);
    for (const CurveKey& key : curve.keys) {
      EXPECT_EQ(valueAt(curve, key.time_s), key.value) << easing;
      EXPECT_EQ(heldValueAt(curve, key.time_s), key.value) << easing;
    }
    EXPECT_EQ(valueAt(curve, -1e9), 2);
    EXPECT_EQ(valueAt(curve, 1e9), 1e6);
    EXPECT_EQ(heldValueAt(curve, -1e9), 2);
  }
}

TEST(Curve, GoesOneWayBetweenTwoKeysAndStaysBetweenTheirValues) {
  for (const char* easing : {"linear", "smooth"}) {
    const Curve curve = someCurve(easing);
    for (std::size_t k = 0; k + 1 < curve.keys.size(); ++k) {
      const CurveKey &a = curve.keys[k], &b = curve.keys[k + 1];
      const double low = std::min(a.value, b.value), high = std::max(a.value, b.value);
      const double sign = b.value >= a.value ? 1 : -1;
      double before = a.value;
      for (int i = 1; i < 1000; ++i) {
        const double value = valueAt(curve, a.time_s + (b.time_s - a.time_s) * i / 1000);
        EXPECT_GE(value, low);
        EXPECT_LE(value, high);
        EXPECT_GE(sign * (value - before), -1e-9);
        before = value;
      }
    }
  }
}

TEST(Curve, EasesAsItsKeySays) {
  Curve curve{{{0, 0, "linear"}, {2, 8, "smooth"}, {4, 0, "step"}, {6, 5, "linear"}}};
  EXPECT_DOUBLE_EQ(valueAt(curve, 0.5), 2);
  EXPECT_DOUBLE_EQ(valueAt(curve, 2.5), 8 - 8 * (3 * 0.0625 - 2 * 0.015625));
  EXPECT_DOUBLE_EQ(valueAt(curve, 5.9), 0);
  curve.keys[0].easing = "bouncing";
  EXPECT_DOUBLE_EQ(valueAt(curve, 0.5), 2) << "one of a later version counts as linear";
  EXPECT_DOUBLE_EQ(heldValueAt(curve, 3.9), 8);
}

TEST(Curve, IsRefusedWhereItsTimesDoNotAscendOrSomethingIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<Curve, std::string>> bad = {
      {{{{0, 1}, {0, 2}}}, "keys[1]: expected a time after 0 s, found 0 s"},
      {{{{2, 1}, {1, 2}}}, "keys[1]"},
      {{{{nan, 1}}}, "keys[0]"},
      {{{{0, nan}}}, "keys[0]"},
      {{{{1e300, 1}}}, "keys[0]"}};
  for (const auto& [curve, told] : bad)
    EXPECT_THAT(messageOf(Error::Kind::Data, [&, &c = curve] { validate(c); }), HasSubstr(told));
}

// --- Fields ---

constexpr std::size_t scalars(bool) { return 1; }
constexpr std::size_t scalars(double) { return 1; }
std::size_t scalars(const std::string&) { return 1; }
std::size_t scalars(const dvec3&) { return 3; }
std::size_t scalars(const FileReference&) { return 2; }
template <class... T>
std::size_t scalarsOf(const T&... members) {
  return (scalars(members) + ...);
}

// A member more than is taken apart here does not compile; one that is not described fails.
TEST(Fields, ListEveryScalarOfEachKind) {
  const auto& [a1, b1, c1, d1, e1] = DirectionalLight{};
  EXPECT_EQ(fieldsOf(DirectionalLight{}).size(), scalarsOf(a1, b1, c1, d1, e1));
  const auto& [a2, b2, c2, d2, e2] = PointLight{};
  EXPECT_EQ(fieldsOf(PointLight{}).size(), scalarsOf(a2, b2, c2, d2, e2));
  const auto& [a3, b3, c3, d3, e3, f3, g3, h3] = SpotLight{};
  EXPECT_EQ(fieldsOf(SpotLight{}).size(), scalarsOf(a3, b3, c3, d3, e3, f3, g3, h3));
  const auto& [a4, b4, c4, d4, e4, f4, g4, h4] = RectangleLight{};
  EXPECT_EQ(fieldsOf(RectangleLight{}).size(), scalarsOf(a4, b4, c4, d4, e4, f4, g4, h4));
  const auto& [a5, b5, c5, d5, e5, f5, unknown5] = EnvironmentLight{};
  EXPECT_EQ(fieldsOf(EnvironmentLight{}).size(), scalarsOf(a5, b5, c5, d5, e5, f5));
  const auto& [a6, b6, unknown6] = Background{};
  EXPECT_EQ(fieldsOf(Background{}).size(), scalarsOf(a6, b6));
  const auto& [a7, b7, unknown7] = CameraPath{};
  EXPECT_EQ(fieldsOf(CameraPath{}).size(), scalarsOf(a7, b7));
  const auto& [a8, b8, c8, unknown8] = CurveKey{};
  EXPECT_EQ(fieldsOf(CurveKey{}).size(), scalarsOf(a8, b8, c8));
  const auto& [id9, a9, b9, kind9, unknown9] = newLight("x", "portal");
  EXPECT_EQ(fieldsOf(newLight("x", "portal")).size(), scalarsOf(a9, b9));
  Look look;
  const auto& [name10, lighting10, a10, b10, background10, path10, curves10, unknown10] = look;
  EXPECT_EQ(fieldsOf(look).size(), scalarsOf(a10, b10) + fieldsOf(lighting10).size() +
                                       fieldsOf(background10).size() + fieldsOf(path10).size());
}

TEST(Fields, EachOneCountsInEquality) {
  const Look look = randomLook(1);
  testing::changeEachField(look, [&](const std::string& name, const Look& other) {
    EXPECT_NE(other, look) << name;
    EXPECT_EQ(at(other, 0) == at(look, 0), look.curves.contains(name)) << name;
  });
  EXPECT_EQ(Look(look), look);
}

TEST(Fields, TellRangesUnitsAndWhatHoldsWhenNothingIsSaid) {
  for (const std::string& kind : lightKinds()) {
    const Light light = newLight("one", kind);
    EXPECT_EQ(kindOf(light), kind);
    Look look;
    look.lighting.lights = {light};
    validate(look);
    EXPECT_THAT(remarks(look), IsEmpty());
    for (const Field& field : fieldsOf(look)) {
      EXPECT_FALSE(field.info.label.empty()) << field.info.name;
      EXPECT_TRUE(field.info.help.ends_with(".")) << field.info.name;
      EXPECT_EQ(field.info.name.ends_with("_deg"), field.info.unit == "deg") << field.info.name;
      const bool in_metres =
          field.info.name.find("_m.") != std::string::npos || field.info.name.ends_with("_m");
      EXPECT_EQ(in_metres, field.info.unit == "m") << field.info.name;
      if (field.info.choices.empty()) continue;
      EXPECT_EQ(std::get<std::string>(field.value), field.info.choices.front())
          << "the first choice is the default: " << field.info.name;
    }
  }
  EXPECT_EQ(kindOf(newLight("one", "portal")), "portal");
}

TEST(Fields, AreSetByPathAndAWrongPathNamesTheNearest) {
  Look look = lookWithKeyLight();
  setField(look, "lights.key.color.g", 0.5);
  EXPECT_EQ(std::get<SpotLight>(look.lighting.lights[0].kind).color.y, 0.5);
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { setField(look, "lights.key.intensty", 1); }),
              HasSubstr("lights.key.intensity"));
  const Look before = look;
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { setField(look, "lights.key.outer_deg", 200); }),
              HasSubstr("0 to 90 deg, found 200"));
  messageOf(Error::Kind::Usage, [&] { setField(look, "view_transform", std::string("filmic")); });
  EXPECT_EQ(look, before);
}

// --- Looks over time ---

TEST(Look, AtAKeyHasTheValueOfTheKeyInEveryFieldThatHasCurves) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Look look = randomLook(seed);
    validate(look);
    for (const auto& [path, curve] : look.curves) {
      for (const CurveKey& key : curve.keys) {
        const Look now = at(look, key.time_s);
        EXPECT_THAT(now.curves, IsEmpty());
        for (const Field& field : fieldsOf(now)) {
          if (field.info.name != path) continue;
          const bool* on = std::get_if<bool>(&field.value);
          EXPECT_EQ(on ? *on : std::get<double>(field.value), key.value) << path;
        }
      }
    }
  }
}

TEST(Look, WithoutCurvesIsTheSameAtAnyTime) {
  Look look = randomLook(3);
  look.curves.clear();
  for (const double time_s : {-5.0, 0.0, 7.5}) EXPECT_EQ(at(look, time_s), look);
}

TEST(Look, ValuesBesideTheCurvesStayAsTheyAre) {
  Look look = lookWithKeyLight();
  look.curves["lights.key.intensity"] = {{{0, 1}, {2, 5}}};
  look.curves["lights.key.enabled"] = {{{0, 1}, {1, 0}}};
  Look now = at(look, 1);
  EXPECT_EQ(std::get<SpotLight>(now.lighting.lights[0].kind).intensity, 3);
  EXPECT_FALSE(now.lighting.lights[0].enabled);
  EXPECT_TRUE(at(look, 0.99).lighting.lights[0].enabled) << "a switch is held, whatever the easing";
  now.lighting = look.lighting;
  now.curves = look.curves;
  EXPECT_EQ(now, look);
}

TEST(Look, WhatThisProgramDoesNotKnowIsKeptAndNamed) {
  Look look = lookWithKeyLight();
  look.lighting.lights.push_back(newLight("hole", "portal"));
  look.view_transform = "filmic";
  look.curves["lights.gone.intensity"] = {{{0, 1}}};
  look.curves["lights.hole.depth"] = {{{0, 1}}};
  look.curves["background.kind"] = {{{0, 1}}};
  look.curves["exposure_stops"] = {{{0, 1, "bouncing"}}};
  look.curves["environment.gain"].unknown = R"({"follows": "music"})";
  validate(look);
  EXPECT_THAT(remarks(look),
              ElementsAre(AllOf(HasSubstr("light \"hole\""), HasSubstr("\"portal\"")),
                          AllOf(HasSubstr("view_transform is \"filmic\""), HasSubstr("standard holds")),
                          AllOf(HasSubstr("background.kind"), HasSubstr("text")),
                          AllOf(HasSubstr("environment.gain"), HasSubstr("no keys")),
                          AllOf(HasSubstr("exposure_stops"), HasSubstr("bouncing")),
                          AllOf(HasSubstr("lights.gone.intensity"), HasSubstr("no such field"))));
  const Look now = at(look, 0);
  EXPECT_EQ(now.view_transform, "standard");
  EXPECT_EQ(now.lighting, look.lighting) << "the light is still there, for whoever knows it";
  EXPECT_EQ(now.exposure_stops, 1);
}

TEST(Look, IsRefusedWithThePlaceOfWhatIsWrong) {
  const std::vector<std::pair<std::function<void(Look&)>, std::string>> bad = {
      {[](Look& l) { l.lighting.lights.push_back(newLight("key", "point")); }, "lights[1]"},
      {[](Look& l) { l.lighting.lights[0].id = "a.b"; }, "lights[0]: expected an id"},
      {[](Look& l) { l.lighting.lights[0].id = ""; }, "lights[0]: expected an id"},
      {[](Look& l) { std::get<SpotLight>(l.lighting.lights[0].kind).outer_deg = 91; },
       "lights.key.outer_deg expects a number from 0 to 90 deg, found 91"},
      {[](Look& l) { l.lighting.environment.gain = std::numeric_limits<double>::infinity(); },
       "environment.gain"},
      {[](Look& l) { l.exposure_stops = 99; }, "exposure_stops"},
      {[](Look& l) {
         l.curves["exposure_stops"] = {{{0, 99}}};
       },
       "curves.exposure_stops.keys[0].value"},
      {[](Look& l) {
         l.curves["lights.key.shadows"] = {{{0, 1}, {1, 0.5}}};
       },
       "curves.lights.key.shadows.keys[1].value: expected 0 or 1"},
      {[](Look& l) {
         l.curves["nothing"] = {{{1, 0}, {0, 0}}};
       },
       "curves.nothing.keys[1]: expected"},
      {[](Look& l) { l.lighting.lights.resize(kMostLights + 1); }, "at most 256"}};
  for (const auto& [spoil, told] : bad) {
    Look look = lookWithKeyLight();
    validate(look);
    spoil(look);
    EXPECT_THAT(refusal(look), HasSubstr(told));
  }
}

TEST(Look, HasANameThatCanBeAFolder) {
  for (const char* good : {"studio", "Studio 2", "a.b", "\xc3\xa9t\xc3\xa9"}) EXPECT_TRUE(isLookName(good));
  for (const char* bad : {"", ".", "..", ".hidden", "a/b", "a\\b", "a\nb"}) EXPECT_FALSE(isLookName(bad));
  EXPECT_FALSE(isLookName(std::string(101, 'x')));
}

// --- Where lights point ---

double apart(const dvec3& a, const dvec3& b) { return glm::length(a - b); }

TEST(Lighting, AnglesOfASunAreThoseOfThePanorama) {
  const auto to = [](double azimuth, double elevation) {
    DirectionalLight light;
    light.azimuth_deg = azimuth, light.elevation_deg = elevation;
    return directionTo(light);
  };
  EXPECT_LT(apart(to(0, 0), {0, 0, 1}), 1e-12);
  EXPECT_LT(apart(to(90, 0), {1, 0, 0}), 1e-12) << "as a positive rotation of the environment";
  EXPECT_LT(apart(to(123, 90), {0, 1, 0}), 1e-12);
  EXPECT_LT(apart(to(0, -45), {0, -std::sqrt(0.5), std::sqrt(0.5)}), 1e-12);
}

TEST(Lighting, WhatIsAimedShinesAtItsTargetWithItsWidthLevel) {
  const std::vector<dvec3> targets = {{0, 1, 0}, {4, -2, 1}, {1, 9, 1}, {1, -9, 1}, {1, 2, 1}};
  const dvec3 position(1, 2, 1);
  for (const dvec3& target : targets) {
    const dmat3 level = aimed(position, target, 0);
    EXPECT_NEAR(glm::determinant(level), 1, 1e-12);
    EXPECT_NEAR(level[0].y, 0, 1e-12);
    EXPECT_GE(level[1].y, -1e-12);
    const dvec3 wanted = target == position ? dvec3(0, -1, 0) : glm::normalize(target - position);
    EXPECT_LT(apart(-level[2], wanted), 1e-12);
    const dmat3 rolled = aimed(position, target, 90);
    EXPECT_LT(apart(rolled[0], level[1]), 1e-12);
    EXPECT_LT(apart(rolled[1], -level[0]), 1e-12);
    EXPECT_LT(apart(rolled[2], level[2]), 1e-12);
  }
}

}  // namespace
}  // namespace beam
