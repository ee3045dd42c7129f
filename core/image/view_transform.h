// SPDX-License-Identifier: Apache-2.0
// From scene-linear light to what is shown.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/math/types.h"

namespace beam {

// "standard": sRGB, clipped; "neutral": Khronos PBR Neutral, then sRGB.
const std::vector<std::string>& viewTransforms();

// Scene-linear Rec.709, >= 0, to sRGB-encoded in [0, 1]. Throws Error{Usage} for a name that is none of
// viewTransforms().
using ViewTransform = vec3 (*)(vec3 linear);
ViewTransform viewTransformOf(std::string_view name);

}  // namespace beam
