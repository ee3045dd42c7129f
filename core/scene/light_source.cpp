// SPDX-License-Identifier: Apache-2.0
#include "core/scene/light_source.h"

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

vec3 strengthOf(double intensity, const dvec3& color) { return vec3(intensity * color); }

// 1 up to `inner`, 0 from `outer` on, smoothstep between.
float fadeOut(float angle, float inner, float outer) {
  if (angle >= outer) return 0;
  if (angle <= inner) return 1;
  const float t = (outer - angle) / (outer - inner);
  return t * t * (3 - 2 * t);
}

float windowOf(float distance_m, float range_m) {
  if (range_m <= 0) return 1;
  const float share = distance_m / range_m, square = share * share;
  const float rest = std::max(0.0f, 1 - square * square);
  return rest * rest;
}

std::vector<LightSource> placesOf(const DirectionalLight& l) {
  return {{.far = true, .toward = vec3(directionTo(l)), .strength = strengthOf(l.intensity, l.color)}};
}

std::vector<LightSource> placesOf(const PointLight& l) {
  return {{.position_m = vec3(l.position_m),
           .strength = strengthOf(l.intensity, l.color),
           .range_m = static_cast<float>(l.range_m)}};
}

std::vector<LightSource> placesOf(const SpotLight& l) {
  const auto outer = static_cast<float>(glm::radians(l.outer_deg));
  return {{.position_m = vec3(l.position_m),
           .strength = strengthOf(l.intensity, l.color),
           .axis = vec3(-aimed(l.position_m, l.target_m, 0)[2]),
           .range_m = static_cast<float>(l.range_m),
           .cone = true,
           .inner_rad = std::min(static_cast<float>(glm::radians(l.inner_deg)), outer),
           .outer_rad = outer}};
}

std::vector<LightSource> placesOf(const RectangleLight& l) {
  const dmat3 world_from_light = aimed(l.position_m, l.target_m, l.roll_deg);
  const double share_m2 = l.width_m * l.height_m / kRectanglePoints;
  std::vector<LightSource> places;
  static_assert(kRectanglePoints == 8, "v below turns three bits around");
  for (int i = 0; i < kRectanglePoints; ++i) {
    // Hammersley's points about their mean.
    const double u = (i + 0.5) / kRectanglePoints - 0.5;
    const double v = ((i & 1) * 4 + (i & 2) + (i >> 2) + 0.5) / kRectanglePoints - 0.5;
    places.push_back(
        {.position_m = vec3(l.position_m + world_from_light * dvec3(u * l.width_m, v * l.height_m, 0)),
         .strength = strengthOf(l.intensity * share_m2, l.color),
         .axis = vec3(-world_from_light[2]),
         .area_m2 = static_cast<float>(share_m2)});
  }
  return places;
}

std::vector<LightSource> placesOf(const UnknownLight&) { return {}; }

}  // namespace

std::vector<LightSource> sourcesOf(const Light& light) {
  return std::visit([](const auto& kind) { return placesOf(kind); }, light.kind);
}

ArrivingLight arrivingAt(const LightSource& s, vec3 x_m) {
  if (s.far) return {.toward = s.toward, .irradiance = s.strength};
  const vec3 to = s.position_m - x_m;
  const float distance_m = glm::length(to);
  ArrivingLight a;
  if (distance_m > 0) a.toward = to / distance_m;
  a.distance_m = distance_m;
  const float near = std::max(distance_m, kNearestLight_m);
  // Exact on the axis of a disc; without an area the square of the distance.
  float share = windowOf(distance_m, s.range_m) / (near * near + s.area_m2 / kPi);
  if (s.axis != vec3(0)) {
    const float cosine = std::clamp(-glm::dot(a.toward, s.axis), -1.0f, 1.0f);
    const float fade = s.cone ? fadeOut(std::acos(cosine), s.inner_rad, s.outer_rad) : 0;
    share *= s.cone ? fade * fade : std::max(0.0f, cosine);
  }
  a.irradiance = share * s.strength;
  return a;
}

float cosineOfDisc(float cosine, float half_angle_rad) {
  if (cosine >= half_angle_rad) return cosine;
  if (cosine <= -half_angle_rad) return 0;
  const float s = cosine / half_angle_rad, chord = std::sqrt(1 - s * s);
  return half_angle_rad *
         (s * (0.5f + (std::asin(s) + s * chord) / kPi) + 2 / (3 * kPi) * chord * chord * chord);
}

}  // namespace beam
