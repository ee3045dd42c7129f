// SPDX-License-Identifier: Apache-2.0
// A lamp as light paths meet it: a place, or a rectangle that is as likely drawn as hit. World axes, metres.
#pragma once

#include <limits>

#include "core/scene/light_source.h"

namespace beam {

struct LampSample {
  vec3 toward{0, 1, 0};  // unit
  vec3 position_m{0};
  float distance_m = std::numeric_limits<float>::infinity();
  vec3 light{0};  // radiance where `pdf` > 0, else the irradiance of what faces it
  float pdf = 0;  // per steradian; 0: it has no extent
};

class PathLamp {
 public:
  explicit PathLamp(const Light& light);  // of one of lightKinds()
  bool wide() const { return area_m2_ > 0; }
  bool shadows() const { return shadows_; }
  // `u`, in [0, 1)^2, is of no account where it is not wide.
  LampSample sample(vec3 x_m, vec2 u) const;
  // What sample() gives where it draws `direction`, of a wide one; no light: it is not there.
  LampSample at(vec3 x_m, vec3 direction) const;

 private:
  LampSample of(vec3 x_m, vec3 position_m) const;

  LightSource source_;  // of a wide one its middle, with the strength of all of it
  bool shadows_ = true;
  vec3 right_{0}, up_{0};  // a wide one's edges
  float area_m2_ = 0;
};

}  // namespace beam
