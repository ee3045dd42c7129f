// SPDX-License-Identifier: Apache-2.0
#include "core/io/camera_track_json.h"

#include <utility>

#include "core/io/described_json.h"

namespace beam {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kFormat = "beam-camera-path";

CameraTrack trackFrom(Json members) {
  JsonObject object(std::move(members), "");
  CameraTrack track;
  for (Json& value : object.takeArray("keys", kMostKeys)) {
    JsonObject key(std::move(value), fmt::format("keys[{}]", track.keys.size()));
    track.keys.emplace_back();
    key.read(track.keys.back());
    track.keys.back().unknown = key.rest();
  }
  track.unknown = object.rest();
  validate(track);
  return track;
}

}  // namespace

std::string toJson(const CameraTrack& track) {
  OrderedJson j;
  j["keys"] = OrderedJson::array();
  for (const CameraKey& key : track.keys) {
    j["keys"].push_back(jsonOfFields(key));
    putUnknown(j["keys"].back(), key.unknown);
  }
  putUnknown(j, track.unknown);
  return documentText(kFormat, j);
}

CameraTrack parseCameraTrack(std::string_view json, std::string_view where) {
  return readDocument(json, kFormat, where, trackFrom);
}

std::vector<std::string> unknownMembers(const CameraTrack& track) {
  std::vector<std::string> paths = membersOf("", track.unknown);
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    for (std::string& path : membersOf(fmt::format("keys[{}]", i), track.keys[i].unknown))
      paths.push_back(std::move(path));
  }
  return paths;
}

}  // namespace beam
