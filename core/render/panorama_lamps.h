// SPDX-License-Identifier: Apache-2.0
// The sun of a panorama, or the lamps of its studio, as lights that cast shadows of their own: what is bright
// and narrow is beyond the third degree in which the visibility of Gaussians is known (methods 7.9).
#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/scene/light_source.h"

namespace beam {

inline constexpr std::size_t kMostPanoramaLamps = 4;

struct SplitPanorama {
  std::vector<LightSource> lamps;  // far, in the axes of the panorama; the strongest first
  Image<vec3> rest;                // what is left; empty where there are no lamps: all of it
};

// Touching texels above 20 times the mean are a lamp where a surface that faces it has 3 % of the mean
// irradiance or more from it. One that is wider than a disc of 12 degrees is split. What is above the mean
// goes into the lamp, so that rest and lamps together give the irradiance of the whole, but for light that
// grazes a surface to 1 % of the lamp's. Luminances decide. Throws Cancelled when the progress is stopped.
SplitPanorama splitPanorama(const Image<vec3>& panorama, const Progress& progress = Progress{});

}  // namespace beam
