// SPDX-License-Identifier: Apache-2.0
// What a project says of pictures in other light, where no look does.
#pragma once

#include "core/pipeline/project.h"
#include "core/scene/lighting.h"

namespace beam {

inline constexpr const char* kRelightStage = "relight";
inline constexpr const char* kEnvironmentShadows = "environment_shadows";

// A panorama alone, its shadows as `relight.environment_shadows` has them; as they are where nothing is said
// in a project whose pipeline has no such setting.
Lighting plainLighting(const Project& project);

}  // namespace beam
