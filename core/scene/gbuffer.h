// SPDX-License-Identifier: Apache-2.0
// What a deferred renderer knows of a view, one value a pixel; all images of one size, empty = not asked for.
#pragma once

#include "core/image/image.h"

namespace beam {

inline constexpr float kVisibleAlpha = 1 / 255.0f;  // with less there is no surface
inline constexpr float kDepthAlpha = 0.5f;          // with less, depth says nothing

struct GBuffer {
  Image<float> alpha;              // coverage, [0, 1]
  Image<float> depth_m;            // median z along the optical axis, 0 where alpha < kDepthAlpha
  Image<vec3> normal_world;        // unit, 0 where alpha < kVisibleAlpha
  Image<vec3> radiance;            // sRGB-encoded, composited on black
  Image<vec3> base_color;          // linear, composited on black: value x alpha
  Image<float> ambient_occlusion;  // value x alpha
  Image<float> roughness;          // value x alpha
};

}  // namespace beam
