// SPDX-License-Identifier: Apache-2.0
// What a view shows and how: one plain value. The splat view holds one; panels, the command line and the
// saved layout read and write it.
#pragma once

#include <optional>

#include "core/scene/channel.h"
#include "core/scene/ids.h"
#include "viewers/false_color.h"
#include "viewers/orbit_camera.h"

namespace beam {

struct ViewState {
  OrbitCamera orbit;
  std::optional<ViewIndex> look_through;  // a camera of the capture instead of the orbit
  ChannelInfo channel = channelOf(kRelightChannel);
  float exposure_stops = 0;
  float yaw_rad = 0;                   // turns the light about +Y
  bool sky = false;                    // show the panorama behind the subject
  float photo_opacity = 0;             // of the photograph over the render, [0, 1]
  std::optional<Limits> depth_limits;  // of the colours of depth, metres; nothing: as each picture asks
};

}  // namespace beam
