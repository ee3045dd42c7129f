// SPDX-License-Identifier: Apache-2.0
// What the cameras of a rig look at, and from how far: the size of a capture where nothing else tells it.
#pragma once

#include <optional>
#include <span>

#include "core/scene/camera.h"

namespace beam {

// The point nearest to all optical axes, by least squares.
class AxesPoint {
 public:
  void add(const dmat3& camera_from_world, const dvec3& translation);
  // Of parallel axes any point on them would do; it is one near the world's origin.
  dvec3 point() const;
  // Whether the axes differ enough in direction, by about 4 degrees, to tell the point's depth.
  bool isKnown() const;

 private:
  dmat3 across_ = dmat3(0.0);
  dvec3 offset_ = dvec3(0);
  int axes_ = 0;
};

struct RigFocus {
  dvec3 point;        // nearest to all axes
  dvec3 middle;       // mean position of the cameras
  double distance_m;  // median of the cameras' distances to the point, > 0; in the cameras' own unit
};
// Nothing where the axes are parallel or the point lies behind half of the cameras.
std::optional<RigFocus> focusOf(std::span<const Camera> cameras);

}  // namespace beam
