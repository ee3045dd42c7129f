// SPDX-License-Identifier: Apache-2.0
// A camera that circles a point, +Y up: the free camera of the views. Angles in radians, drags in pixels.
#pragma once

#include "core/scene/camera.h"

namespace beam {

struct Bounds {
  vec3 center_m = vec3(0);
  float radius_m = 1;
};

// Where the eye stands: Front at +Z of the target, Right at +X, Top at +Y with +X to the right on the screen.
enum class ViewPreset { Front, Back, Left, Right, Top, Bottom };

struct OrbitCamera {
  vec3 target_m = vec3(0, 1, 0);
  float azimuth_rad = 0;       // 0: the eye is at +Z of the target; grows towards +X
  float elevation_rad = 0.1f;  // towards +Y, kept inside +-89 degrees by drags
  float distance_m = 3;
  float field_of_view_rad = 0.7f;  // vertical

  // The hand drags the scene: to the right turns its front to the right, down shows its top.
  void orbit(vec2 drag_px);
  // What lies at the target's depth stays under the hand.
  void pan(vec2 drag_px, int height_px);
  // Steps of a wheel; positive comes closer.
  void zoom(float steps);
  // What lies at the target's depth under the pointer stays there; pixels as in camera(size_px.x, size_px.y).
  void zoomAt(float steps, vec2 pointer_px, ivec2 size_px);
  // Looks along an axis; keeps target and distance.
  void turnTo(ViewPreset preset);
  // Circles this point from now on, from as far away as the eye is from it now; keeps the direction.
  void focusOn(vec3 point_m);
  // Moves back until the bounds fill the picture; keeps the direction.
  void frame(const Bounds& bounds);

  Camera camera(int width_px, int height_px) const;
};

// The orbit that sees what `camera` sees, around a point `distance_m` in front of it; roll is dropped.
OrbitCamera orbitOf(const Camera& camera, float distance_m);

}  // namespace beam
