// SPDX-License-Identifier: Apache-2.0
#include "core/io/look_json.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/io/scene_document_json.h"
#include "tests/support/random_look.h"

namespace beam {
namespace {

using Json = nlohmann::json;
using ::testing::AllOf;
using testing::changeEachField;
using testing::filled;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::randomLook;

template <class Body>
std::string refusal(Body&& body) {
  try {
    body();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Data) << e.what();
    EXPECT_THAT(e.what(), Not(HasSubstr("exception")));
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

Look again(const Look& look) { return parseLook(toJson(look), "look.json"); }
SceneDocument again(const SceneDocument& document) {
  return parseSceneDocument(toJson(document), "scene.json");
}

SceneDocument randomScene(std::uint64_t seed) {
  const dmat3 turn =
      glm::mat3_cast(glm::normalize(dquat(0.7, 0.3, -0.5, 0.4 + 0.01 * static_cast<double>(seed))));
  SceneDocument d;
  d.performances.assign(2, filled(Performance{}, seed));
  d.performances[0].scene_from_performance = {turn, 1 / 3.0, dvec3(0.1, -2e-9, 7)};
  d.performances[0].unknown =
      R"({"cast":"x","scene_from_performance":{"by":"hand","translation_m":{"w":1}}})";
  d.meshes = {filled(SceneMesh{}, seed)};
  d.meshes[0].unknown = R"({"base_color":{"texture":"a.png"},"double_sided":true})";
  d.ground = filled(Ground{}, seed);
  d.ground.unknown = R"({"grid":{"step_m":1}})";
  d.look = randomLook(seed);
  d.unknown = R"({"cameras":[{"name":"A"}],"title":"Test"})";
  return d;
}

// Every path in a document: "/lights/0/color/r".
void listPaths(const Json& j, const std::string& path, std::vector<std::string>& paths) {
  if (!path.empty()) paths.push_back(path);
  if (!j.is_structured()) return;
  for (const auto& [name, value] : j.items()) listPaths(value, path + "/" + name, paths);
}

TEST(LookJson, WhatIsReadIsWhatWasWritten) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Look look = randomLook(seed);
    EXPECT_EQ(again(look), look) << seed;
    EXPECT_EQ(toJson(again(look)), toJson(look));
  }
  const Look nothing_said;
  EXPECT_EQ(again(nothing_said), nothing_said);
}

TEST(LookJson, EachFieldComesBack) {
  const Look look = randomLook(7);
  changeEachField(look, [&](const std::string& name, const Look& changed) {
    Look plain = changed;  // curves may drive what was changed out of their range
    plain.curves.clear();
    EXPECT_EQ(again(plain), plain) << name;
  });
}

TEST(LookJson, SeveralKeepTheirOrder) {
  std::vector<Look> looks = {randomLook(3), randomLook(1), randomLook(2)};
  EXPECT_EQ(parseLooks(looksToJson(looks)), looks);
  looks.push_back(looks[0]);
  EXPECT_THAT(refusal([&] { parseLooks(looksToJson(looks)); }),
              AllOf(HasSubstr("looks[3]"), HasSubstr("there twice")));
  looks[3].name = "a/b";
  EXPECT_THAT(refusal([&] { parseLooks(looksToJson(looks)); }), HasSubstr("looks[3].name"));
}

TEST(LookJson, ALaterVersionsMembersAreThereAgainInEveryObject) {
  // A member more in every object that there is: its own, those inside, lights, keys.
  const std::function<void(Json&, int&)> enrich = [&](Json& j, int& n) {
    for (auto& value : j) {
      if (value.is_structured()) enrich(value, n);
    }
    if (j.is_object()) j[fmt::format("later_{}", n)] = {{"deep", {1, nullptr, "x", ++n}}};
  };
  Json look = Json::parse(toJson(randomLook(4)));
  const Json curves = look["curves"];  // an object by path, where any member is a curve
  look.erase("curves"), look.erase("format");
  int n = 0;
  enrich(look, n);
  EXPECT_GT(n, 20);
  look["curves"] = curves;
  for (auto& curve : look["curves"]) enrich(curve, n);
  look["format"] = {{"name", "beam-look"}, {"major", 1}, {"minor", 0}};
  EXPECT_EQ(Json::parse(toJson(parseLook(look.dump(), "x"))), look);
}

TEST(LookJson, ALightOfUnknownKindIsKeptWhole) {
  const char* text = R"({"format": {"name": "beam-look", "major": 1, "minor": 4},
    "lights": [{"id": "hole", "kind": "portal", "title": "", "enabled": false, "size": {"w": 2, "h": [1, 2]},
                "intensity": "very"}], "view_transform": "filmic"})";
  const Look look = parseLook(text, "x");
  EXPECT_EQ(kindOf(look.lighting.lights.at(0)), "portal");
  EXPECT_EQ(remarks(look).size(), 2u);
  const Json written = Json::parse(toJson(look));
  EXPECT_EQ(written["lights"], Json::parse(text)["lights"]);
  EXPECT_EQ(written["view_transform"], "filmic");
}

TEST(LookJson, WhatAnEarlierVersionDidNotSayIsAsWhenNothingIsSaid) {
  const Look look = parseLook(R"({"format": {"name": "beam-look", "major": 1, "minor": 0},
      "lights": [{"id": "key", "kind": "spot", "color": {"g": 0.5}}]})",
                              "x");
  Look expected;
  expected.lighting.lights = {newLight("key", "spot")};
  std::get<SpotLight>(expected.lighting.lights[0].kind).color.y = 0.5;
  EXPECT_EQ(look, expected);
}

TEST(LookJson, WhatIsWrongIsToldWithItsPlaceAndWhatWasExpected) {
  Look look;
  look.name = "day";
  look.lighting.lights = {newLight("key", "spot"), newLight("sun", "directional")};
  look.curves["exposure_stops"] = {{{0, 1}, {2, 3}}};
  const Json good = Json::parse(toJson(look));
  const std::vector<std::tuple<std::string, Json, std::string>> bad = {
      {"/lights/1/intensity", "bright",
       "lights[1].intensity: expected a number of at least 0, found \"bright\""},
      {"/lights/0/color", 3, "lights[0].color: expected an object, found 3"},
      {"/lights/0/color/r", -1, "lights.key.color.r expects"},
      {"/lights/0/outer_deg", 95, "lights.key.outer_deg expects a number from 0 to 90 deg, found 95"},
      {"/lights/0/shadows", 1, "lights[0].shadows: expected true or false, found 1"},
      {"/lights/0/id", "sun", "the id \"sun\" is there twice"},
      {"/lights/0/id", "a b", "lights[0]: expected an id"},
      {"/lights/0/kind", nullptr, "lights[0].kind: expected a text, found null"},
      {"/lights/0", 7, "lights[0]: expected an object"},
      {"/lights", Json::object(), "lights: expected an array, found {}"},
      {"/environment/file/absolute", false, "environment.file.absolute: expected text"},
      {"/name", 5, "name: expected a text, found 5"},
      {"/curves", Json::array(), "curves: expected an object"},
      {"/curves/exposure_stops/keys/1/time_s", 0, "curves.exposure_stops.keys[1]: expected a time after 0 s"},
      {"/curves/exposure_stops/keys/1/value", 31,
       "curves.exposure_stops.keys[1].value: expected a number from"},
      {"/curves/exposure_stops/keys/0", "x", "curves.exposure_stops.keys[0]: expected an object"},
      {"/format/major", 2, "newer BEAM Studio"},
      {"/format/name", "beam-scene", "format.name: expected \"beam-look\", found \"beam-scene\""},
      {"/format", nullptr, "format: expected an object"}};
  for (const auto& [path, value, told] : bad) {
    Json j = good;
    j[Json::json_pointer(path)] = value;
    EXPECT_THAT(refusal([&] { parseLook(j.dump(), "my look.json"); }),
                AllOf(HasSubstr(told), HasSubstr("\"my look.json\"")));
  }
  for (const char* text : {"", "{", "[]", "null", "{\"format\": 1e999}"})
    EXPECT_THAT(refusal([&] { parseLook(text, "my look.json"); }), HasSubstr("\"my look.json\""));
}

TEST(LookJson, HostileSizesAreRefusedByName) {
  const auto withLights = [](std::size_t n) {
    Json j = {{"format", {{"name", "beam-look"}, {"major", 1}}}, {"lights", Json::array()}};
    for (std::size_t i = 0; i < n; ++i)
      j["lights"].push_back({{"id", fmt::format("l{}", i)}, {"kind", "point"}});
    return j.dump();
  };
  EXPECT_EQ(parseLook(withLights(kMostLights), "x").lighting.lights.size(), kMostLights);
  EXPECT_THAT(refusal([&] { parseLook(withLights(kMostLights + 1), "x"); }),
              HasSubstr("lights: expected at most 256 elements, found 257"));
  for (const char* open : {"[", "{\"a\":"}) {
    std::string deep = "{\"x\": ";
    for (int i = 0; i < 200'000; ++i) deep += open;
    EXPECT_THAT(refusal([&] { parseLook(deep, "x"); }), HasSubstr("levels"));
  }
}

TEST(LookJson, DamageAnywhereIsBadInput) {
  Look whole = randomLook(2);
  std::erase_if(whole.curves, [](const auto& c) { return !c.first.starts_with("lights.point_1.position"); });
  const std::string good = toJson(whole);
  for (std::size_t length = 0; length + 2 < good.size(); length += 101)
    refusal([&] { parseLook(good.substr(0, length), "x"); });
  const Json j = Json::parse(good);
  std::vector<std::string> paths;
  listPaths(j, "", paths);
  for (const std::string& path : paths) {
    for (const Json& other : {Json("x"), Json(-1e300), Json(true), Json(nullptr), Json::array({1})}) {
      Json damaged = j;
      damaged[Json::json_pointer(path)] = other;
      try {  // some are just another value or of a later version
        const Look look = parseLook(damaged.dump(), "x");
        EXPECT_EQ(again(look), look) << path << " " << other;
      } catch (const Error& e) {
        EXPECT_EQ(e.kind(), Error::Kind::Data) << path << " " << other;
      }
    }
  }
}

TEST(SceneDocumentJson, WhatIsReadIsWhatWasWritten) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const SceneDocument document = randomScene(seed);
    EXPECT_EQ(again(document), document) << seed;
    EXPECT_EQ(toJson(again(document)), toJson(document));
  }
  const SceneDocument nothing_said;
  EXPECT_EQ(again(nothing_said), nothing_said);
  const SceneDocument plain = randomScene(1);
  changeEachField(plain.performances[0], [&](const std::string& name, const Performance& changed) {
    SceneDocument d = plain;
    d.performances[0] = changed;
    EXPECT_EQ(again(d), d) << name;
  });
  changeEachField(plain.meshes[0], [&](const std::string& name, const SceneMesh& changed) {
    SceneDocument d = plain;
    d.meshes[0] = changed;
    EXPECT_EQ(again(d), d) << name;
  });
  changeEachField(plain.ground, [&](const std::string& name, const Ground& changed) {
    SceneDocument d = plain;
    d.ground = changed;
    EXPECT_EQ(again(d), d) << name;
  });
}

TEST(SceneDocumentJson, WhatIsWrongIsToldWithItsPlace) {
  const Json good = Json::parse(toJson(randomScene(1)));
  const std::vector<std::tuple<std::string, Json, std::string>> bad = {
      {"/performances", 1, "performances: expected an array"},
      {"/performances/1/speed", "fast", "performances[1].speed: expected a number"},
      {"/performances/1/frames", 3, "performances[1].frames: expected text"},
      {"/performances/0/scene_from_performance/rotation", {1, 2}, "rotation: expected three rows"},
      {"/performances/0/scene_from_performance/rotation/2/1", "x", "rotation[2][1]: expected a number"},
      {"/performances/0/scene_from_performance/rotation/0", {1, 1, 1}, "rotation: expected rows of length 1"},
      {"/performances/0/scene_from_performance/scale", -2, "expected a scale over 0"},
      {"/meshes/0/scene_from_mesh", "here", "meshes[0].scene_from_mesh: expected an object"},
      {"/ground/roughness", 7, "ground.roughness expects"},
      {"/look/lights/0/intensity", -1, "look.lights.directional_1.intensity expects"},
      {"/look/lights/0/intensity", "x", "look.lights[0].intensity: expected"},
      {"/format/major", 2, "newer BEAM Studio"}};
  for (const auto& [path, value, told] : bad) {
    Json j = good;
    j[Json::json_pointer(path)] = value;
    EXPECT_THAT(refusal([&] { parseSceneDocument(j.dump(), "my scene.json"); }),
                AllOf(HasSubstr(told), HasSubstr("\"my scene.json\"")));
  }
}

}  // namespace
}  // namespace beam
