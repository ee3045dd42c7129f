// SPDX-License-Identifier: Apache-2.0
// Shadows of Gaussians in the light of one place (methods 7.3), in a form that blending without order draws:
// nearest depth, and what gets through all. Casters are the Gaussians whose outward side is turned away from
// the light, as far as that is known: where light leaves a body and not where it falls on it, which leaves
// nothing for a surface to shadow itself with (BlendRules has the same rule for rays). What gets through
// counts casters behind a surface as well: one behind a veil and before a body is as dark as the body's back.
// World axes, metres.
#pragma once

#include <cstddef>
#include <vector>

#include "core/math/types.h"
#include "core/scene/light_source.h"

namespace beam {

inline constexpr int kShadowSize = 512;          // texels a side
inline constexpr float kShadowOffset_m = 0.02f;  // from a surface along its normal, as of visibility rays
// Behind the nearest depth where casters may be the surface itself.
inline constexpr float kShadowBias_m = 0.02f;
inline constexpr float kCastingAlpha = 0.3f;  // of a Gaussian that a nearest depth is taken of

struct Sphere {
  vec3 center_m{0};
  float radius_m = 0;
};

// How one square map looks at the scene: +X right, +Y down, +Z the way that light travels.
struct ShadowView {
  mat3 world_from_light{1};
  vec3 origin_m{0};  // of a parallel view the middle of its map; else the light
  bool parallel = false;
  float half_width = 1;  // metres of a parallel view; else the tangent of half its angle
  int size = kShadowSize;
};

// Of what casts in `sphere`: one view of all of it, however narrow or wide the light itself is; six faces of
// a cube where it is inside the sphere, or so near that half the angle is over 60 degrees.
std::vector<ShadowView> shadowViewsOf(const LightSource& source, const Sphere& sphere);

// Row after row.
struct ShadowTexels {
  std::vector<float> front;    // depth along +Z from which on things are shadowed; infinity: nothing casts
  std::vector<float> through;  // the product of 1 - alpha of all casters
};

struct ShadowMap {
  std::vector<ShadowView> views;
  std::vector<ShadowTexels> texels;  // of each
  float bias_m = 0;

  std::size_t bytes() const;
  // The share of light that comes to a point, [0, 1]: over four texels, each compared for itself.
  float lightAt(vec3 x_m) const;
  // Of a disc infinitely far, as a parallel view sees it: over a penumbra as wide as the mean of what stands
  // in the way makes it (percentage-closer soft shadows, Fernando 2005).
  float lightAt(vec3 x_m, float half_angle_rad) const;

 private:
  struct Place {  // in the texels of a view
    std::size_t view = 0;
    float u = 0, v = 0, z = 0;
    bool inside = false;
  };
  Place placeOf(vec3 x_m) const;
  bool blocked(const Place& p, std::size_t texel) const { return p.z > texels[p.view].front[texel] + bias_m; }
  float shareAt(const Place& p) const;
};

}  // namespace beam
