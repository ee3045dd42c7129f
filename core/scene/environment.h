// SPDX-License-Identifier: Apache-2.0
// Light from all around: a linear lat-long panorama (OpenEXR = USD DomeLight: top row +Y, image centre +Z, +X
// at one quarter of the width), and a table to draw directions from it.
#pragma once

#include <array>
#include <string>

#include "core/image/image.h"

namespace beam {

struct Environment {
  Image<vec3> radiance;  // scene-linear Rec.709, finite, >= 0
  float yaw_rad = 0;     // turns the light about +Y; positive moves it from +Z towards +X
  float gain = 1;
};

// Texture position of a direction: u = 0.5 - atan2(x, z) / 2 pi, v = 0.5 - asin(y) / pi, both in [0, 1].
vec2 latLongFromDirection(vec3 direction);
vec3 directionFromLatLong(vec2 uv);

// Bilinear, across the seam, at a texture position in [0, 1] or a unit direction.
vec3 lookUp(const Image<vec3>& panorama, vec2 uv);
inline vec3 lookUp(const Image<vec3>& panorama, vec3 direction) {
  return lookUp(panorama, latLongFromDirection(direction));
}

// Radiance from `direction` (unit, pointing to the light), bilinear, yaw and gain applied.
vec3 radianceFrom(const Environment& environment, vec3 direction);

// What is wrong with the shape of a panorama called `name`; empty: it is twice as wide as high.
std::string shapeDoubt(const Image<vec3>& radiance, const std::string& name);

// Clears negative and non-finite texels (logged, but for negative ones nearer to 0 than 1e-3), throws
// Error{Data} when the panorama is empty.
Environment makeEnvironment(Image<vec3> radiance);

// Mean radiance over the sphere and the direction of the brightest texel, for `beam check`.
vec3 meanRadiance(const Environment& environment);
vec3 brightestDirection(const Environment& environment);

// Draws directions with density proportional to luminance (piecewise constant over the texels, solid angle
// exact).
class EnvironmentSampler {
 public:
  // `yaw_rad` and `gain` come on top of its own.
  explicit EnvironmentSampler(const Environment& environment, float yaw_rad = 0, float gain = 1);
  struct Sample {
    vec3 direction;
    vec3 radiance;  // of the texel, constant over it
    float pdf;      // per steradian
  };
  Sample sample(float u1, float u2) const;
  Sample at(vec3 direction) const;  // what sample() gives when it draws `direction`
  float pdf(vec3 direction) const;
  vec3 texelRadiance(vec3 direction) const;

 private:
  int width_ = 0, height_ = 0;
  float yaw_rad_ = 0;
  Image<vec3> radiance_;          // gain applied
  std::vector<float> row_cdf_;    // height + 1
  std::vector<float> texel_cdf_;  // height rows of width + 1
  std::vector<float> pdf_;        // per steradian, per texel
};

// Irradiance of the panorama as 9 SH coefficients per channel, cosine lobe applied (Ramamoorthi-Hanrahan
// 2001): E(n) = irradiance(sh, n), in radiance units times steradian.
std::array<vec3, 9> irradianceSh(const Environment& environment);
vec3 irradiance(const std::array<vec3, 9>& sh, vec3 normal);

}  // namespace beam
