// SPDX-License-Identifier: Apache-2.0
// A light as the places that it shines from: the one falloff of every renderer, whatever draws the shadow
// (methods 7.6). World axes, metres, scene-linear Rec.709.
#pragma once

#include <limits>
#include <vector>

#include "core/math/types.h"
#include "core/scene/lighting.h"

namespace beam {

inline constexpr float kNearestLight_m = 0.01f;  // nearer ones count as that far: no light without end
inline constexpr int kRectanglePoints = 8;

// One place.
struct LightSource {
  bool far = false;      // in the direction `toward`, infinitely far; false: at `position_m`
  vec3 toward{0, 1, 0};  // unit
  vec3 position_m{0};
  vec3 strength{0};          // far: irradiance of what faces it; else radiant intensity along `axis`
  vec3 axis{0, 0, 0};        // unit, the way it shines; 0: to all sides
  float range_m = 0;         // of its window; 0: without end
  float half_angle_rad = 0;  // of a far one: of the disc that it is, which softens its shadows; 0: a point
  // With an axis. A cone: whole up to `inner_rad` from it, nothing past `outer_rad`, of which the inner one
  // is never more. Else it is flat: the cosine with the axis weakens it.
  bool cone = false;
  float area_m2 =
      0;  // that a flat one stands for: a disc, which near by is brighter in no direction than itself
  float inner_rad = 0, outer_rad = 0;

  bool operator==(const LightSource&) const = default;
  // Whether both cast the same shadow.
  bool standsWith(const LightSource& other) const {
    return far == other.far && (far ? toward == other.toward : position_m == other.position_m);
  }
};

// Of a light that is one of lightKinds(): one place, kRectanglePoints of a rectangle. Empty for others.
std::vector<LightSource> sourcesOf(const Light& light);

// What of it comes to a point, whatever stands between.
struct ArrivingLight {
  vec3 toward{0, 1, 0};  // unit, to the light
  float distance_m = std::numeric_limits<float>::infinity();
  vec3 irradiance{0};  // of what faces it
};
ArrivingLight arrivingAt(const LightSource& source, vec3 x_m);

// The mean of max(0, n.w) over a small even disc whose middle lies at that cosine from n: it sets behind a
// surface little by little (methods 7.9).
float cosineOfDisc(float cosine, float half_angle_rad);

}  // namespace beam
