// SPDX-License-Identifier: Apache-2.0
#include "core/scene/camera.h"

#include <fmt/format.h>
#include <algorithm>

#include <cmath>

#include "core/base/error.h"

namespace beam {

void validate(const Camera& camera, std::string_view name) {
  const auto refuse = [&](std::string_view what, double found) {
    throw Error(Error::Kind::Data, fmt::format("camera \"{}\": {}, found {}", name, what, found));
  };
  const Intrinsics& k = camera.intrinsics;
  if (!(std::isfinite(k.fx) && k.fx > 0)) refuse("expected a positive focal length fx in pixels", k.fx);
  if (!(std::isfinite(k.fy) && k.fy > 0)) refuse("expected a positive focal length fy in pixels", k.fy);
  if (!std::isfinite(k.cx)) refuse("expected a finite principal point cx in pixels", k.cx);
  if (!std::isfinite(k.cy)) refuse("expected a finite principal point cy in pixels", k.cy);
  if (camera.width <= 0) refuse("expected a positive picture width", camera.width);
  if (camera.height <= 0) refuse("expected a positive picture height", camera.height);
  const dquat& q = camera.camera_from_world.rotation;
  const double norm = glm::dot(q, q);
  if (!(std::abs(norm - 1.0) < 1e-6))
    refuse("expected a unit quaternion as its rotation, of squared norm 1", norm);
  for (int i = 0; i < 3; ++i) {
    const double t = camera.camera_from_world.translation_m[i];
    if (!std::isfinite(t)) refuse("expected a finite translation", t);
  }
  validate(camera.lens, name);
}

Camera scaledDown(const Camera& camera, int factor) {
  Camera c = camera;
  c.width = camera.width / factor;
  c.height = camera.height / factor;
  const double sx = static_cast<double>(c.width) / camera.width,
               sy = static_cast<double>(c.height) / camera.height;
  c.intrinsics = {camera.intrinsics.fx * sx, camera.intrinsics.fy * sy, camera.intrinsics.cx * sx,
                  camera.intrinsics.cy * sy};
  return c;
}

Camera fittedTo(const Camera& camera, int width_px, int height_px) {
  const double scale =
      std::min(static_cast<double>(width_px) / camera.width, static_cast<double>(height_px) / camera.height);
  Camera c = camera;
  c.width = width_px;
  c.height = height_px;
  c.intrinsics = {camera.intrinsics.fx * scale, camera.intrinsics.fy * scale,
                  camera.intrinsics.cx * scale + 0.5 * (width_px - scale * camera.width),
                  camera.intrinsics.cy * scale + 0.5 * (height_px - scale * camera.height)};
  return c;
}

}  // namespace beam
