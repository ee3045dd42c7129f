// SPDX-License-Identifier: Apache-2.0
// Rays of a camera's pixels, through their centres unless a place in the pixel is named.
#pragma once

#include <cstddef>
#include <vector>

#include "core/math/rigid3.h"
#include "core/scene/camera.h"

namespace beam {

class PixelRays {
 public:
  explicit PixelRays(const Camera& camera)
      : world_from_camera_(inverse(camera.camera_from_world)),
        intrinsics_(camera.intrinsics),
        x_(static_cast<std::size_t>(camera.width)),
        y_(static_cast<std::size_t>(camera.height)) {
    for (std::size_t x = 0; x < x_.size(); ++x) x_[x] = rayOf(camera.intrinsics, {x + 0.5, 0.5}).x;
    for (std::size_t y = 0; y < y_.size(); ++y) y_[y] = rayOf(camera.intrinsics, {0.5, y + 0.5}).y;
  }
  const dquat& worldFromCamera() const { return world_from_camera_.rotation; }
  const dvec3& eye() const { return world_from_camera_.translation_m; }
  // Not unit: 1 along the optical axis. In camera axes, and in the world's.
  dvec3 through(int x, int y) const {
    return {x_[static_cast<std::size_t>(x)], y_[static_cast<std::size_t>(y)], 1};
  }
  dvec3 worldThrough(int x, int y) const { return worldFromCamera() * through(x, y); }
  dvec3 worldThrough(int x, int y, dvec2 in_pixel) const {
    return worldFromCamera() * rayOf(intrinsics_, dvec2(x, y) + in_pixel);
  }
  vec3 toEye(int x, int y) const { return vec3(-glm::normalize(worldThrough(x, y))); }
  vec3 at(int x, int y, float z_m) const {
    return vec3(eye() + worldFromCamera() * (static_cast<double>(z_m) * through(x, y)));
  }

 private:
  Rigid3 world_from_camera_;
  Intrinsics intrinsics_;
  std::vector<double> x_, y_;  // of columns and rows: a division a pixel would be a tenth of its shading
};

}  // namespace beam
