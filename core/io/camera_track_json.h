// SPDX-License-Identifier: Apache-2.0
// Camera paths as JSON files: {"format": {"name": "beam-camera-path", ...}, "keys": [{"time_s", "position_m":
// {"x", "y", "z"}, "target_m", "roll_deg", "fov_deg", "easing"}]}. Members of a later version come back as
// they were.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/camera_track.h"

namespace beam {

std::string toJson(const CameraTrack& track);
// Throws Error{Data} that names `where`, the place in it, what was expected and found; also for a track that
// is not valid or of a newer major format.
CameraTrack parseCameraTrack(std::string_view json, std::string_view where);
// As of a look (io/look_json.h).
std::vector<std::string> unknownMembers(const CameraTrack& track);

}  // namespace beam
