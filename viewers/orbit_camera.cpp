// SPDX-License-Identifier: Apache-2.0
#include "viewers/orbit_camera.h"

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

constexpr float kRadiansPerPixel = 0.007f;
constexpr float kSteepest_rad = 1.5533f;  // 89 degrees: a drag over the pole would turn the scene upside down
constexpr float kNearest_m = 0.02f, kFarthest_m = 500.0f;

struct Axes {
  vec3 right, down, forward;
};

Axes axesOf(float azimuth, float elevation) {
  const float ca = std::cos(azimuth), sa = std::sin(azimuth), ce = std::cos(elevation),
              se = std::sin(elevation);
  const vec3 forward(-ce * sa, -se, -ce * ca), right(ca, 0, -sa);
  return {right, glm::cross(forward, right), forward};
}

float metresPerPixel(const OrbitCamera& orbit, int height_px) {
  return 2 * orbit.distance_m * std::tan(orbit.field_of_view_rad / 2) / static_cast<float>(height_px);
}

}  // namespace

void OrbitCamera::orbit(vec2 drag_px) {
  azimuth_rad = std::remainder(azimuth_rad - kRadiansPerPixel * drag_px.x, 2 * kPi);
  elevation_rad = std::clamp(elevation_rad + kRadiansPerPixel * drag_px.y, -kSteepest_rad, kSteepest_rad);
}

void OrbitCamera::pan(vec2 drag_px, int height_px) {
  const Axes axes = axesOf(azimuth_rad, elevation_rad);
  target_m -= metresPerPixel(*this, height_px) * (drag_px.x * axes.right + drag_px.y * axes.down);
}

void OrbitCamera::zoom(float steps) {
  distance_m = std::clamp(distance_m * std::pow(0.88f, steps), kNearest_m, kFarthest_m);
}

void OrbitCamera::zoomAt(float steps, vec2 pointer_px, ivec2 size_px) {
  const float before = metresPerPixel(*this, size_px.y);
  zoom(steps);
  const vec2 from_middle = (before - metresPerPixel(*this, size_px.y)) * (pointer_px - 0.5f * vec2(size_px));
  const Axes axes = axesOf(azimuth_rad, elevation_rad);
  target_m += from_middle.x * axes.right + from_middle.y * axes.down;
}

void OrbitCamera::turnTo(ViewPreset preset) {
  const bool pole = preset == ViewPreset::Top || preset == ViewPreset::Bottom;
  elevation_rad = !pole ? 0.0f : preset == ViewPreset::Top ? kPi / 2 : -kPi / 2;
  azimuth_rad = preset == ViewPreset::Right  ? kPi / 2
                : preset == ViewPreset::Left ? -kPi / 2
                : preset == ViewPreset::Back ? kPi
                                             : 0.0f;
}

void OrbitCamera::focusOn(vec3 point_m) {
  const vec3 eye = target_m - distance_m * axesOf(azimuth_rad, elevation_rad).forward;
  distance_m = std::clamp(glm::distance(eye, point_m), kNearest_m, kFarthest_m);
  target_m = point_m;
}

void OrbitCamera::frame(const Bounds& bounds) {
  target_m = bounds.center_m;
  distance_m = std::clamp(bounds.radius_m / std::sin(field_of_view_rad / 2), kNearest_m, kFarthest_m);
}

Camera OrbitCamera::camera(int width_px, int height_px) const {
  const Axes axes = axesOf(azimuth_rad, elevation_rad);
  const vec3 eye = target_m - distance_m * axes.forward;
  // Rows of camera_from_world are the camera's axes in the world.
  const dmat3 camera_from_world =
      glm::transpose(dmat3(dvec3(axes.right), dvec3(axes.down), dvec3(axes.forward)));
  Camera c;
  c.width = width_px;
  c.height = height_px;
  const double focal_px = 0.5 * height_px / std::tan(0.5 * field_of_view_rad);
  c.intrinsics = {focal_px, focal_px, 0.5 * width_px, 0.5 * height_px};
  c.camera_from_world.rotation = glm::normalize(glm::quat_cast(camera_from_world));
  c.camera_from_world.translation_m = -(c.camera_from_world.rotation * dvec3(eye));
  return c;
}

OrbitCamera orbitOf(const Camera& camera, float distance_m) {
  const Rigid3 world_from_camera = inverse(camera.camera_from_world);
  const vec3 forward(world_from_camera.rotation * dvec3(0, 0, 1));
  OrbitCamera o;
  o.distance_m = distance_m;
  o.target_m = vec3(world_from_camera.translation_m) + distance_m * forward;
  o.elevation_rad = std::clamp(std::asin(std::clamp(-forward.y, -1.0f, 1.0f)), -kSteepest_rad, kSteepest_rad);
  o.azimuth_rad = std::atan2(-forward.x, -forward.z);
  o.field_of_view_rad = static_cast<float>(2 * std::atan(0.5 * camera.height / camera.intrinsics.fy));
  return o;
}

}  // namespace beam
