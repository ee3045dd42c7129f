// SPDX-License-Identifier: Apache-2.0
#include "core/render/shadow_map.h"

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

constexpr float kWidestSine = 0.8660254f;  // of half the angle of one view: 60 degrees
constexpr float kFaceMargin = 1.02f;       // faces overlap, so that no texel beyond an edge is asked for
constexpr float kNearPlane_m = 1e-4f;

mat3 lookingAlong(vec3 z) {
  const vec3 up = std::abs(z.y) > 0.9f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  const vec3 x = glm::normalize(glm::cross(up, z));
  return {x, glm::cross(z, x), z};
}

ShadowView faceOf(int face, vec3 position_m) {
  vec3 axis(0);
  axis[face / 2] = face % 2 == 0 ? 1.0f : -1.0f;
  return {.world_from_light = lookingAlong(axis), .origin_m = position_m, .half_width = kFaceMargin};
}

int faceToward(vec3 d) {
  const vec3 a = glm::abs(d);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  return 2 * axis + (d[axis] < 0);
}

}  // namespace

std::vector<ShadowView> shadowViewsOf(const LightSource& source, const Sphere& sphere) {
  if (source.far) {
    return {{.world_from_light = lookingAlong(-source.toward),
             .origin_m = sphere.center_m,
             .parallel = true,
             .half_width = std::max(sphere.radius_m, 1e-3f)}};
  }
  const vec3 to = sphere.center_m - source.position_m;
  const float distance_m = glm::length(to);
  if (sphere.radius_m > kWidestSine * distance_m) {
    std::vector<ShadowView> faces;
    for (int face = 0; face < 6; ++face) faces.push_back(faceOf(face, source.position_m));
    return faces;
  }
  const float sine = std::max(sphere.radius_m / distance_m, 1e-4f);
  return {{.world_from_light = lookingAlong(to / distance_m),
           .origin_m = source.position_m,
           .half_width = sine / std::sqrt(1 - sine * sine)}};
}

std::size_t ShadowMap::bytes() const {
  std::size_t sum = 0;
  for (const ShadowTexels& t : texels) sum += sizeof(float) * (t.front.size() + t.through.size());
  return sum;
}

float ShadowMap::lightAt(vec3 x_m) const {
  if (views.empty()) return 1;
  const std::size_t i = views.size() == 1 ? 0 : static_cast<std::size_t>(faceToward(x_m - views[0].origin_m));
  const ShadowView& view = views[i];
  const vec3 p = (x_m - view.origin_m) * view.world_from_light;
  if (!view.parallel && p.z < kNearPlane_m) return 1;
  const float scale = 0.5f * static_cast<float>(view.size) / view.half_width / (view.parallel ? 1 : p.z);
  const float middle = 0.5f * static_cast<float>(view.size) - 0.5f, last = static_cast<float>(view.size - 1);
  const float u = middle + scale * p.x, v = middle + scale * p.y;
  if (!(u > -1 && v > -1 && u < last + 1 && v < last + 1)) return 1;
  const float cu = std::clamp(u, 0.0f, last), cv = std::clamp(v, 0.0f, last);
  const int x0 = std::min(static_cast<int>(cu), view.size - 2),
            y0 = std::min(static_cast<int>(cv), view.size - 2);
  const float fu = cu - static_cast<float>(x0), fv = cv - static_cast<float>(y0);
  const std::size_t at = static_cast<std::size_t>(y0) * view.size + x0;
  const auto light = [&](std::size_t t) {
    return p.z > texels[i].front[t] + bias_m ? texels[i].through[t] : 1.0f;
  };
  const float top = (1 - fu) * light(at) + fu * light(at + 1);
  const float bottom = (1 - fu) * light(at + view.size) + fu * light(at + view.size + 1);
  return (1 - fv) * top + fv * bottom;
}

}  // namespace beam
