// SPDX-License-Identifier: Apache-2.0
// A camera: a pinhole with its full principal point behind a lens. Camera axes: +X right, +Y down, +Z forward
// (OpenCV).
#pragma once

#include <string_view>

#include "core/math/rigid3.h"
#include "core/scene/lens.h"

namespace beam {

struct Intrinsics {
  double fx = 0, fy = 0, cx = 0, cy = 0;  // pixels; pixel (0, 0) has its centre at (0.5, 0.5)

  bool operator==(const Intrinsics&) const = default;
};

struct Camera {
  Intrinsics intrinsics;
  int width = 0, height = 0;
  Rigid3 camera_from_world;
  Lens lens = {};

  bool operator==(const Camera&) const = default;
};

// Throws Error{Data} naming `name` unless focal lengths and size are positive, everything is finite and the
// lens is known.
void validate(const Camera& camera, std::string_view name);

inline dvec3 centerOf(const Camera& c) { return inverse(c.camera_from_world).translation_m; }

// Pixel position of a point in camera axes, of a pinhole; z > 0.
inline dvec2 project(const Intrinsics& k, const dvec3& x_in_camera) {
  return {k.fx * x_in_camera.x / x_in_camera.z + k.cx, k.fy * x_in_camera.y / x_in_camera.z + k.cy};
}

// Ray through a pixel position, of a pinhole, in camera axes, z = 1: x_in_camera = z_depth * rayOf(k, p).
inline dvec3 rayOf(const Intrinsics& k, const dvec2& p) {
  return {(p.x - k.cx) / k.fx, (p.y - k.cy) / k.fy, 1.0};
}

// The camera whose pictures are `factor` times smaller a side (sizes rounded down).
Camera scaledDown(const Camera& camera, int factor);
// The camera whose pictures have this size and show all that `camera` sees, as large as there is room; what
// is over of another shape shows more beside it.
Camera fittedTo(const Camera& camera, int width_px, int height_px);

}  // namespace beam
