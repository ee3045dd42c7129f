// SPDX-License-Identifier: Apache-2.0
// "--size WIDTHxHEIGHT" of commands that make pictures.
#pragma once

#include <string_view>

#include "core/math/types.h"

namespace beam {

inline constexpr const char* kPictureSizeHelp = "in pixels of 16 to 8192";

// Throws Error{Usage} for what is no size, or one out of range.
ivec2 parsePictureSize(std::string_view text);

}  // namespace beam
