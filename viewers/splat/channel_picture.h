// SPDX-License-Identifier: Apache-2.0
// A channel as a picture for the screen, and what a pixel says in words; the table of channels says how.
#pragma once

#include <string>

#include "core/scene/channel.h"
#include "viewers/false_color.h"

namespace beam {

// Behind everything, scene-linear; sRGB 27 28 30.
inline constexpr vec3 kBackdrop(0.0110f, 0.0116f, 0.0130f);

struct ChannelOptions {
  float exposure_stops = 0;  // of colours, not of data
  Limits limits = {};        // of false colour
};

// sRGB, opaque. `values` as the channel's row says, empty: none, which gives what is behind alone. `sky`:
// linear radiance behind the subject, or empty for the backdrop. All of one size.
Image<u8vec4> channelPicture(const ChannelInfo& channel, const Planes& values, const Planes& alpha,
                             const Image<vec3>& sky, const ChannelOptions& options);

// "Base colour linear 0.521 0.310 0.204 · alpha 1.00"; values of the surface, not multiplied by alpha.
std::string describePixel(const ChannelInfo& channel, const Planes& values, const Planes& alpha, int x,
                          int y);

}  // namespace beam
