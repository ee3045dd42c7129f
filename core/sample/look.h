// SPDX-License-Identifier: Apache-2.0
// Procedural materials of the figure, by its rest pose, and the panoramas that light it.
#pragma once

#include <string>

#include "core/sample/figure.h"
#include "core/scene/environment.h"

namespace beam {

struct FigureLook {
  vec3 base_color{0};  // linear
  float roughness = 0.5f;
};
FigureLook lookOf(const FigurePoint& point);

// Softboxes of different tint in a grey dome over a darker floor.
Environment domeLight();
// "studio": one large key from the performer's front left; "sunset": a low warm sun and a blue sky.
Environment namedLight(const std::string& name);

}  // namespace beam
