// SPDX-License-Identifier: Apache-2.0
#include "core/io/scene_document_json.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/json_words.h"
#include "core/io/described_json.h"
#include "core/io/look_json.h"
#include "core/io/look_value.h"
#include "core/scene/described_values.h"

namespace beam {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kFormat = "beam-scene";

// A member that is a similarity, but for its rotation: that is a matrix, for a quaternion would round it.
struct Placement {
  const char* name;
  Similarity3* similarity;
};
void describe(Fields& f, Placement& p) {
  f.group(p.name, [&] {
    f.field({.name = "scale", .label = "Scale", .help = "Lengths there for one of its own."},
            p.similarity->scale);
    describePosition(f, "translation_m", {.name = "", .label = "Place", .help = "Of its origin."},
                     p.similarity->translation);
  });
}

void putPlacement(OrderedJson& object, const char* name, Similarity3 similarity) {
  object.update(jsonOfFields(Placement{name, &similarity}));
  OrderedJson rows = OrderedJson::array();
  const dmat3& r = similarity.rotation;  // r[column][row]
  for (int row = 0; row < 3; ++row) rows.push_back({r[0][row], r[1][row], r[2][row]});
  object[name]["rotation"] = std::move(rows);
}

void readRotation(const Json& rows, const std::string& place, dmat3& rotation) {
  const auto threeOf = [](const Json& j) { return j.is_array() && j.size() == 3; };
  if (!threeOf(rows)) refuseJson(place, "three rows", rows);
  for (int row = 0; row < 3; ++row) {
    if (!threeOf(rows[row])) refuseJson(fmt::format("{}[{}]", place, row), "three numbers", rows[row]);
    for (int column = 0; column < 3; ++column) {
      const Json& number = rows[row][column];
      if (!number.is_number()) refuseJson(fmt::format("{}[{}][{}]", place, row, column), "a number", number);
      rotation[column][row] = number.get<double>();
    }
  }
}

void readPlacement(JsonObject& object, const char* name, Similarity3& similarity) {
  Placement placement{name, &similarity};
  object.read(placement);
  const std::string path = fmt::format("{}.rotation", name);
  if (const std::optional<Json> rows = object.take(path))
    readRotation(*rows, object.placeOf(path), similarity.rotation);
}

OrderedJson jsonOf(const Performance& performance) {
  OrderedJson j = jsonOfFields(performance);
  putPlacement(j, "scene_from_performance", performance.scene_from_performance);
  putUnknown(j, performance.unknown);
  return j;
}

OrderedJson jsonOf(const SceneMesh& mesh) {
  OrderedJson j = jsonOfFields(mesh);
  putPlacement(j, "scene_from_mesh", mesh.scene_from_mesh);
  putUnknown(j, mesh.unknown);
  return j;
}

Performance performanceFrom(Json value, const std::string& place) {
  JsonObject object(std::move(value), place);
  Performance performance;
  object.read(performance);
  readPlacement(object, "scene_from_performance", performance.scene_from_performance);
  performance.unknown = object.rest();
  return performance;
}

SceneMesh meshFrom(Json value, const std::string& place) {
  JsonObject object(std::move(value), place);
  SceneMesh mesh;
  object.read(mesh);
  readPlacement(object, "scene_from_mesh", mesh.scene_from_mesh);
  mesh.unknown = object.rest();
  return mesh;
}

SceneDocument documentFrom(Json members) {
  JsonObject object(std::move(members), "");
  SceneDocument document;
  for (Json& value : object.takeArray("performances", kMostPerformances)) {
    document.performances.push_back(
        performanceFrom(std::move(value), fmt::format("performances[{}]", document.performances.size())));
  }
  for (Json& value : object.takeArray("meshes", kMostMeshes))
    document.meshes.push_back(meshFrom(std::move(value), fmt::format("meshes[{}]", document.meshes.size())));
  if (std::optional<Json> value = object.take("ground")) {
    JsonObject ground(std::move(*value), "ground");
    ground.read(document.ground);
    document.ground.unknown = ground.rest();
  }
  if (std::optional<Json> look = object.take("look")) document.look = lookFromValue(std::move(*look), "look");
  document.unknown = object.rest();
  validate(document);
  return document;
}

}  // namespace

std::string toJson(const SceneDocument& document) {
  OrderedJson j;
  j["performances"] = OrderedJson::array();
  for (const Performance& performance : document.performances)
    j["performances"].push_back(jsonOf(performance));
  j["meshes"] = OrderedJson::array();
  for (const SceneMesh& mesh : document.meshes) j["meshes"].push_back(jsonOf(mesh));
  j["ground"] = jsonOfFields(document.ground);
  putUnknown(j["ground"], document.ground.unknown);
  j["look"] = lookToValue(document.look);
  putUnknown(j, document.unknown);
  return documentText(kFormat, j);
}

bool isSceneDocument(std::string_view json) {
  try {
    const Json members = Json::parse(json, shallowJson<Json>);
    if (!members.is_object() || !members.contains("format") || !members["format"].is_object()) return false;
    return members["format"].value("name", Json()) == kFormat;
  } catch (const Json::exception&) {
    return false;
  }
}

SceneDocument parseSceneDocument(std::string_view json, std::string_view where) {
  return readDocument(json, kFormat, where, documentFrom);
}

std::vector<std::string> unknownMembers(const SceneDocument& document) {
  std::vector<std::string> paths = membersOf("", document.unknown);
  const auto add = [&](const std::string& place, const std::string& unknown) {
    for (std::string& path : membersOf(place, unknown)) paths.push_back(std::move(path));
  };
  for (std::size_t i = 0; i < document.performances.size(); ++i)
    add(fmt::format("performances[{}]", i), document.performances[i].unknown);
  for (std::size_t i = 0; i < document.meshes.size(); ++i)
    add(fmt::format("meshes[{}]", i), document.meshes[i].unknown);
  add("ground", document.ground.unknown);
  for (const std::string& path : unknownMembers(document.look)) paths.push_back("look." + path);
  return paths;
}

}  // namespace beam
