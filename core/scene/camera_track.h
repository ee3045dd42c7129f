// SPDX-License-Identifier: Apache-2.0
// A camera that moves: by keys, or around a subject. World axes, metres, seconds.
#pragma once

#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/math/types.h"
#include "core/scene/camera.h"
#include "core/scene/curve.h"

namespace beam {

struct CameraKey {
  double time_s = 0;
  dvec3 position_m = dvec3(0, 1.2, 3);
  dvec3 target_m = dvec3(0, 1, 0);  // what is in the middle of the picture
  double roll_deg = 0;              // counter-clockwise seen from behind the camera
  double fov_deg = 35;              // from the top of the picture to its bottom
  // From this key to the next: "spline" goes through all keys without a kink (Catmull-Rom over their times),
  // the others are those of CurveKey.
  std::string easing = "spline";
  std::string unknown = "{}";  // members of a later version, kept as they are (a JSON object)

  bool operator==(const CameraKey&) const = default;
};
void describe(Fields& f, CameraKey& key);

struct CameraTrack {
  std::vector<CameraKey> keys;
  std::string unknown = "{}";

  bool operator==(const CameraTrack&) const = default;
};

// Throws Error{Data} that names the key: none or over kMostKeys, numbers out of range, times that do not
// ascend, a target at the position. An easing that this program does not know is none: it counts as spline.
void validate(const CameraTrack& track);

// A sentence of each easing that this program does not know.
std::vector<std::string> remarks(const CameraTrack& track);

// A pinhole of square pixels with its principal point in the middle. Of a valid track; before its first key
// and after its last these hold.
Camera cameraAt(const CameraTrack& track, double time_s, ivec2 size);

// `camera` gone by `turn_rad` around the vertical through `middle_m`, from +Z towards +X, with that still in
// the same place of the picture.
Camera turnedAround(const Camera& camera, const dvec3& middle_m, double turn_rad);

}  // namespace beam
