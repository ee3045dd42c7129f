// SPDX-License-Identifier: Apache-2.0
// The pieces of a prepared light that shade() and its tests share: the split-sum table and lat-long
// convolutions.
#pragma once

#include <functional>

#include "core/image/image.h"

namespace beam {

// Split-sum factors (Karis 2013) of a smooth dielectric: integral of f_s (n.l) = F0 * x + y. `n_dot_v` in [0,
// 1].
vec2 splitSum(float n_dot_v, float roughness);

// The panorama as another of width x height texels, each the mean over its solid angle; never enlarges.
Image<vec3> reducedPanorama(const Image<vec3>& panorama, int width, int height);

// out(d) = integral of panorama(w) kernel(d . w) / integral of kernel; the kernel is 0 below `min_cosine`.
Image<vec3> convolvedPanorama(const Image<vec3>& panorama, ivec2 size, float min_cosine,
                              const std::function<float(float)>& kernel);

// Bilinear look-up, unit direction; turns and gains are the caller's.
vec3 lookUp(const Image<vec3>& panorama, vec3 direction);

}  // namespace beam
