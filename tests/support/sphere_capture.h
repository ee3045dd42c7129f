// SPDX-License-Identifier: Apache-2.0
// Photographs of a textured matte sphere with its masks, made in closed form: the smallest capture with known
// truth.
#pragma once

#include <cmath>
#include <vector>

#include "core/scene/frame_views.h"

namespace beam::testing {

struct SphereCapture {
  float radius_m = 0.3f;
  vec3 center{0, 1, 0};
  int cameras = 10;
  int size_px = 64;
  quat turn{1, 0, 0, 0};  // of the texture, about the centre
};

inline vec3 sphereColor(vec3 n) {
  return 0.5f + 0.35f * vec3(std::sin(5 * n.x), std::cos(4 * n.y), std::sin(3 * n.z));
}

// A camera at `position` that looks at `target`, +Y up in the picture.
inline Camera cameraLookingAt(dvec3 position, dvec3 target, int size_px, double focal_px) {
  const dvec3 forward = glm::normalize(target - position);
  const dvec3 right = glm::normalize(glm::cross(forward, dvec3(0, 1, 0)));
  const dvec3 down = glm::cross(forward, right);
  const dmat3 world_from_camera(right, down, forward);
  Camera c;
  c.width = c.height = size_px;
  c.intrinsics = {focal_px, focal_px, size_px / 2.0, size_px / 2.0};
  c.camera_from_world.rotation = glm::normalize(glm::quat_cast(glm::transpose(world_from_camera)));
  c.camera_from_world.translation_m = -(c.camera_from_world.rotation * position);
  return c;
}

inline FrameView photographSphere(const SphereCapture& s, const Camera& camera, std::string name) {
  FrameView v{std::move(name), camera, Image<u8vec3>(s.size_px, s.size_px, u8vec3(0), Encoding::Srgb),
              Image<std::uint8_t>(s.size_px, s.size_px)};
  const Rigid3 world_from_camera = inverse(camera.camera_from_world);
  const dvec3 o = world_from_camera.translation_m - dvec3(s.center);
  for (int y = 0; y < s.size_px; ++y) {
    for (int x = 0; x < s.size_px; ++x) {
      const dvec3 d =
          glm::normalize(world_from_camera.rotation * rayOf(camera.intrinsics, dvec2(x + 0.5, y + 0.5)));
      const double b = glm::dot(o, d), c = glm::dot(o, o) - s.radius_m * s.radius_m;
      if (b * b < c) continue;
      const vec3 n = glm::normalize(vec3(o + (-b - std::sqrt(b * b - c)) * d));
      v.photo(x, y) = u8vec3(sphereColor(glm::conjugate(s.turn) * n) * 255.0f + 0.5f);
      v.mask(x, y) = 255;
    }
  }
  return v;
}

// Where camera cam<i> stands, and what it is called.
inline View viewOf(const SphereCapture& s, int i) {
  const double z = 1 - (2 * i + 1.0) / s.cameras, r = std::sqrt(1 - z * z), phi = 2.39996323 * i;
  const dvec3 position = dvec3(s.center) + 2.0 * dvec3(r * std::cos(phi), 0.8 * z, r * std::sin(phi));
  return {"cam" + std::to_string(i), cameraLookingAt(position, s.center, s.size_px, 1.4 * s.size_px)};
}

inline std::vector<FrameView> photographs(const SphereCapture& s) {
  std::vector<FrameView> views;
  for (int i = 0; i < s.cameras; ++i) {
    View view = viewOf(s, i);
    views.push_back(photographSphere(s, view.camera, std::move(view.name)));
  }
  return views;
}

}  // namespace beam::testing
