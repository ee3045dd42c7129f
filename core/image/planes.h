// SPDX-License-Identifier: Apache-2.0
// Pictures as planes, the form that EXR files and the engine take.
#pragma once

#include "core/image/image.h"

namespace beam {

Planes planesOf(const Image<float>& image);
// Every pixel turned by `rotation`.
Planes planesOf(const Image<vec3>& image, const dmat3& rotation);

}  // namespace beam
