// SPDX-License-Identifier: Apache-2.0
// Radiance .hdr pictures: new and old run lengths, EXPOSURE lines, any of the eight
// orientations.
#pragma once

#include <filesystem>

#include "core/image/image.h"

namespace beam {

// Linear RGB, rows top to bottom. Throws Error{Data}.
Image<vec3> readRadianceHdr(const std::filesystem::path& path);

}  // namespace beam
