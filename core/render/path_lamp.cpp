// SPDX-License-Identifier: Apache-2.0
#include "core/render/path_lamp.h"

#include <cmath>

namespace beam {

PathLamp::PathLamp(const Light& light) : shadows_(castsShadows(light)) {
  const std::vector<LightSource> sources = sourcesOf(light);
  source_ = sources.at(0);
  const auto* rectangle = std::get_if<RectangleLight>(&light.kind);
  if (!rectangle) return;
  const dmat3 axes = aimed(rectangle->position_m, rectangle->target_m, rectangle->roll_deg);
  source_.position_m = vec3(rectangle->position_m);
  source_.strength *= static_cast<float>(sources.size());
  right_ = vec3(rectangle->width_m * axes[0]);
  up_ = vec3(rectangle->height_m * axes[1]);
  area_m2_ = static_cast<float>(rectangle->width_m * rectangle->height_m);
}

LampSample PathLamp::of(vec3 x_m, vec3 position_m) const {
  LightSource there = source_;
  there.position_m = position_m;
  const ArrivingLight light = arrivingAt(there, x_m);
  LampSample s{light.toward, position_m, light.distance_m, light.irradiance};
  if (!wide()) return s;
  const float cosine = -glm::dot(light.toward, source_.axis);
  if (cosine <= 0 || light.distance_m <= 0) return {};
  // Density 1 / area over the rectangle.
  s.pdf = light.distance_m * light.distance_m / (area_m2_ * cosine);
  s.light = source_.strength / area_m2_;
  return s;
}

LampSample PathLamp::sample(vec3 x_m, vec2 u) const {
  return of(x_m, source_.position_m + (u.x - 0.5f) * right_ + (u.y - 0.5f) * up_);
}

LampSample PathLamp::at(vec3 x_m, vec3 direction) const {
  const float along = glm::dot(direction, source_.axis);  // it shines against what looks at it
  if (along >= 0) return {};
  const float distance_m = glm::dot(source_.position_m - x_m, source_.axis) / along;
  if (!(distance_m > 0)) return {};
  const vec3 hit = x_m + distance_m * direction, from_middle = hit - source_.position_m;
  const bool inside = std::abs(glm::dot(from_middle, right_)) <= 0.5f * glm::dot(right_, right_) &&
                      std::abs(glm::dot(from_middle, up_)) <= 0.5f * glm::dot(up_, up_);
  return inside ? of(x_m, hit) : LampSample{};
}

}  // namespace beam
