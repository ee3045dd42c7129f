// SPDX-License-Identifier: Apache-2.0
// A G-buffer as a picture for the screen, one channel of it; and what a pixel says in words.
#pragma once

#include <string>

#include "core/scene/gbuffer.h"
#include "viewers/false_color.h"
#include "viewers/view_state.h"

namespace beam {

struct ChannelOptions {
  Channel channel = Channel::Radiance;
  float exposure_stops = 0;  // of colours of light and reflectance, not of data
  Limits limits = {};        // of false colour
};

// Whether the G-buffer holds the channel; Lit counts when `lit` is there.
bool holds(const GBuffer& gbuffer, const Image<vec3>& lit, Channel channel);

// sRGB, opaque. `lit`: linear radiance x alpha; `sky`: linear radiance behind the subject, or empty for a
// dark backdrop. A channel that is not held gives the backdrop alone.
Image<u8vec4> channelPicture(const GBuffer& gbuffer, const Image<vec3>& lit, const Image<vec3>& sky,
                             const ChannelOptions& options);

// "base colour 0.521 0.310 0.204 linear · alpha 1.00"; values of the surface, not multiplied by alpha.
std::string describePixel(const GBuffer& gbuffer, const Image<vec3>& lit, Channel channel, int x, int y);

}  // namespace beam
