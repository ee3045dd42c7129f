// SPDX-License-Identifier: Apache-2.0
#include "core/render/shadow_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace beam {
namespace {

constexpr float kWidestSine = 0.8660254f;  // of half the angle of one view: 60 degrees
constexpr float kFaceMargin = 1.02f;       // faces overlap, so that no texel beyond an edge is asked for
constexpr float kNearPlane_m = 1e-4f;

constexpr float kSharp = 0.5f;  // texels; a narrower penumbra is that of a point

// Points of a disc of radius 1, even in area, each on from the last by the golden angle (Vogel 1979).
template <std::size_t N>
std::array<vec2, N> discPoints() {
  std::array<vec2, N> points;
  for (std::size_t i = 0; i < N; ++i) {
    const float radius = std::sqrt((static_cast<float>(i) + 0.5f) / N);
    const float angle = static_cast<float>(i) * 2.3999632f;
    points[i] = radius * vec2(std::cos(angle), std::sin(angle));
  }
  return points;
}
const std::array<vec2, 16> kSearch = discPoints<16>();
const std::array<vec2, 16> kFilter = discPoints<16>();

float texelsOf(const ShadowView& view) {  // a metre, or a unit of the tangent
  return 0.5f * static_cast<float>(view.size) / view.half_width;
}

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

ShadowMap::Place ShadowMap::placeOf(vec3 x_m) const {
  Place place{.view = views.size() == 1 ? 0 : static_cast<std::size_t>(faceToward(x_m - views[0].origin_m))};
  const ShadowView& view = views[place.view];
  const vec3 p = (x_m - view.origin_m) * view.world_from_light;
  if (!view.parallel && p.z < kNearPlane_m) return place;
  const float scale = texelsOf(view) / (view.parallel ? 1 : p.z);
  const float middle = 0.5f * static_cast<float>(view.size) - 0.5f, last = static_cast<float>(view.size - 1);
  place.u = middle + scale * p.x;
  place.v = middle + scale * p.y;
  place.z = p.z;
  place.inside = place.u > -1 && place.v > -1 && place.u < last + 1 && place.v < last + 1;
  return place;
}

float ShadowMap::shareAt(const Place& p) const {
  const int size = views[p.view].size;
  const float last = static_cast<float>(size - 1);
  const float cu = std::clamp(p.u, 0.0f, last), cv = std::clamp(p.v, 0.0f, last);
  const int x0 = std::min(static_cast<int>(cu), size - 2), y0 = std::min(static_cast<int>(cv), size - 2);
  const float fu = cu - static_cast<float>(x0), fv = cv - static_cast<float>(y0);
  const std::size_t at = static_cast<std::size_t>(y0) * size + x0;
  const auto light = [&](std::size_t t) { return blocked(p, t) ? texels[p.view].through[t] : 1.0f; };
  const float top = (1 - fu) * light(at) + fu * light(at + 1);
  const float bottom = (1 - fu) * light(at + size) + fu * light(at + size + 1);
  return (1 - fv) * top + fv * bottom;
}

float ShadowMap::lightAt(vec3 x_m) const {
  if (views.empty()) return 1;
  const Place p = placeOf(x_m);
  return p.inside ? shareAt(p) : 1;
}

float ShadowMap::lightAt(vec3 x_m, float half_angle_rad) const {
  if (views.empty()) return 1;
  const Place p = placeOf(x_m);
  const ShadowView& view = views[0];
  const float texels_per_m = texelsOf(view) * std::tan(half_angle_rad),
              last = static_cast<float>(view.size - 1);
  // What casts lies in the sphere that the view is of: not nearer to the light than its depth.
  const float widest = texels_per_m * std::max(0.0f, p.z + view.half_width);
  if (widest < kSharp) return p.inside ? shareAt(p) : 1;
  float depth = 0, through = 0;
  int blockers = 0;
  for (const vec2& d : kSearch) {
    const float u = p.u + widest * d.x, v = p.v + widest * d.y;
    if (!(u >= 0 && v >= 0 && u <= last && v <= last)) continue;
    const std::size_t t = static_cast<std::size_t>(v + 0.5f) * view.size + static_cast<std::size_t>(u + 0.5f);
    if (!blocked(p, t)) continue;
    ++blockers;
    depth += texels[0].front[t];
    through += texels[0].through[t];
  }
  if (blockers == 0) return 1;
  if (blockers == std::ssize(kSearch)) return through / static_cast<float>(blockers);
  const float penumbra = texels_per_m * (p.z - depth / static_cast<float>(blockers));
  float sum = 0;
  for (const vec2& d : kFilter) {
    const Place at{0, p.u + penumbra * d.x, p.v + penumbra * d.y, p.z, true};
    sum += at.u > -1 && at.v > -1 && at.u < last + 1 && at.v < last + 1 ? shareAt(at) : 1;
  }
  return sum / static_cast<float>(std::ssize(kFilter));
}

}  // namespace beam
