// SPDX-License-Identifier: Apache-2.0
#include "core/io/look_json.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/json_words.h"
#include "core/io/described_json.h"
#include "core/io/look_value.h"

namespace beam {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kFormat = "beam-look";

OrderedJson jsonOf(const Light& light) {
  OrderedJson j;
  j["id"] = light.id;
  j["kind"] = kindOf(light);
  j.update(jsonOfFields(light));
  putUnknown(j, light.unknown);
  return j;
}

OrderedJson jsonOf(const Curve& curve) {
  OrderedJson keys = OrderedJson::array();
  for (const CurveKey& key : curve.keys) {
    keys.push_back(jsonOfFields(key));
    putUnknown(keys.back(), key.unknown);
  }
  OrderedJson j;
  j["keys"] = std::move(keys);
  putUnknown(j, curve.unknown);
  return j;
}

Light lightFrom(Json value, const std::string& place) {
  JsonObject object(std::move(value), place);
  std::string id = object.takeText("id");
  Light light = newLight(std::move(id), object.takeText("kind"));
  object.read(light);
  light.unknown = object.rest();
  return light;
}

Curve curveFrom(Json value, const std::string& place) {
  JsonObject object(std::move(value), place);
  Curve curve;
  for (Json& key : object.takeArray("keys", kMostKeys)) {
    JsonObject read(std::move(key), object.placeOf(fmt::format("keys[{}]", curve.keys.size())));
    curve.keys.emplace_back();
    read.read(curve.keys.back());
    curve.keys.back().unknown = read.rest();
  }
  curve.unknown = object.rest();
  return curve;
}

void readCurves(JsonObject& object, Look& look) {
  std::optional<Json> curves = object.take("curves");
  if (!curves) return;
  if (!curves->is_object()) refuseJson(object.placeOf("curves"), "an object", *curves);
  for (auto& [path, curve] : curves->items())
    look.curves[path] = curveFrom(std::move(curve), object.placeOf("curves." + path));
}

}  // namespace

OrderedJson lookToValue(const Look& look) {
  OrderedJson j = OrderedJson::object();
  if (!look.name.empty()) j["name"] = look.name;
  Look own = look;
  own.lighting.lights.clear();
  j.update(jsonOfFields(own));
  putUnknown(j["environment"], look.lighting.environment.unknown);
  putUnknown(j["background"], look.background.unknown);
  putUnknown(j["camera_path"], look.camera_path.unknown);
  j["lights"] = OrderedJson::array();
  for (const Light& light : look.lighting.lights) j["lights"].push_back(jsonOf(light));
  for (const auto& [path, curve] : look.curves) j["curves"][path] = jsonOf(curve);
  putUnknown(j, look.unknown);
  return j;
}

Look lookFromValue(Json value, const std::string& place) {
  JsonObject object(std::move(value), place);
  Look look;
  object.read(look);  // without lights: theirs are in the array
  look.lighting.environment.unknown = object.restOf("environment");
  look.background.unknown = object.restOf("background");
  look.camera_path.unknown = object.restOf("camera_path");
  for (Json& light : object.takeArray("lights", kMostLights)) {
    look.lighting.lights.push_back(
        lightFrom(std::move(light), object.placeOf(fmt::format("lights[{}]", look.lighting.lights.size()))));
  }
  readCurves(object, look);
  if (std::optional<Json> name = object.take("name")) {
    if (!name->is_string()) refuseJson(object.placeOf("name"), "a text", *name);
    look.name = name->get<std::string>();
  }
  look.unknown = object.rest();
  try {
    validate(look);
  } catch (const Error& e) {
    throw Error(e.kind(), object.placeOf(e.what()));
  }
  return look;
}

std::vector<std::string> unknownMembers(const Look& look) {
  std::vector<std::string> paths;
  const auto add = [&](const std::string& place, const std::string& unknown) {
    for (std::string& path : membersOf(place, unknown)) paths.push_back(std::move(path));
  };
  add("", look.unknown);
  add("environment", look.lighting.environment.unknown);
  add("background", look.background.unknown);
  add("camera_path", look.camera_path.unknown);
  for (const Light& light : look.lighting.lights)
    if (!std::holds_alternative<UnknownLight>(light.kind)) add("lights." + light.id, light.unknown);
  for (const auto& [path, curve] : look.curves) {
    add("curves." + path, curve.unknown);
    for (std::size_t i = 0; i < curve.keys.size(); ++i)
      add(fmt::format("curves.{}.keys[{}]", path, i), curve.keys[i].unknown);
  }
  return paths;
}

std::string toJson(const Look& look) { return documentText(kFormat, lookToValue(look)); }

Look parseLook(std::string_view json, std::string_view where) {
  return readDocument(json, kFormat, where, [](Json value) { return lookFromValue(std::move(value), ""); });
}

std::string looksToJson(const std::vector<Look>& looks) {
  OrderedJson j = OrderedJson::array();
  for (const Look& look : looks) j.push_back(lookToValue(look));
  return j.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

std::vector<Look> parseLooks(std::string_view json) {
  Json array;
  try {
    array = Json::parse(json);
  } catch (const Json::exception& e) {
    throw Error(Error::Kind::Data, fmt::format("looks: {}", jsonComplaint(e)));
  }
  if (!array.is_array()) refuseJson("looks", "an array", array);
  if (array.size() > kMostLooks)
    throw Error(Error::Kind::Data,
                fmt::format("looks: expected at most {}, found {}", kMostLooks, array.size()));
  std::vector<Look> looks;
  std::set<std::string> names;
  for (Json& value : array) {
    const std::string place = fmt::format("looks[{}]", looks.size());
    looks.push_back(lookFromValue(std::move(value), place));
    const std::string& name = looks.back().name;
    if (!isLookName(name)) refuseJson(place + ".name", "a name that can be a folder's", name);
    if (!names.insert(name).second)
      throw Error(Error::Kind::Data, fmt::format("{}: the name \"{}\" is there twice", place, name));
  }
  return looks;
}

}  // namespace beam
