// SPDX-License-Identifier: Apache-2.0
// A panorama as a camera sees it, where nothing stands before it.
#pragma once

#include "core/image/image.h"
#include "core/scene/camera.h"
#include "core/scene/environment.h"
#include "core/scene/lighting.h"

namespace beam {

// Scene-linear; rotation and gain of `light` come on top of the panorama's own.
Image<vec3> skyPicture(const Camera& camera, const EnvironmentLight& light, const Environment& panorama);

}  // namespace beam
