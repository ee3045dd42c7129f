// SPDX-License-Identifier: Apache-2.0
// What a view shows and how: one plain value. The splat view holds one; panels, the command line and the
// saved layout read and write it.
#pragma once

#include <optional>
#include <string_view>

#include "core/scene/ids.h"
#include "viewers/false_color.h"
#include "viewers/orbit_camera.h"

namespace beam {

// In the order of the keys 1 to 7.
enum class Channel { Lit, Radiance, BaseColor, AmbientOcclusion, Roughness, Normal, Depth };
inline constexpr int kChannelCount = 7;

struct ChannelInfo {
  const char* name;    // as typed: "base_color"
  const char* title;   // as shown: "Base colour"
  const char* legend;  // unit and limits, or what the colours mean
};
const ChannelInfo& infoOf(Channel channel);
std::optional<Channel> channelNamed(std::string_view name);

struct ViewState {
  OrbitCamera orbit;
  std::optional<ViewIndex> look_through;  // a camera of the capture instead of the orbit
  Channel channel = Channel::Lit;
  float exposure_stops = 0;
  float yaw_rad = 0;                   // turns the light about +Y
  bool sky = false;                    // show the panorama behind the subject
  float photo_opacity = 0;             // of the photograph over the render, [0, 1]
  std::optional<Limits> depth_limits;  // of the colours of depth, metres; nothing: as each picture asks
};

}  // namespace beam
