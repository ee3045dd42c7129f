// SPDX-License-Identifier: Apache-2.0
#include "viewers/view_state.h"

#include <array>

namespace beam {
namespace {

constexpr std::array<ChannelInfo, kChannelCount> kChannels{{
    {"lit", "Lit", "relit, sRGB"},
    {"radiance", "Radiance", "as photographed, sRGB"},
    {"base_color", "Base colour", "reflectance, sRGB"},
    {"ao", "Ambient occlusion", "0 to 1, grey"},
    {"roughness", "Roughness", "0 to 1"},
    {"normal", "Normal", "world, x y z as r g b, −1 to 1"},
    {"depth", "Depth", "metres along the optical axis"},
}};

}  // namespace

const ChannelInfo& infoOf(Channel channel) { return kChannels[static_cast<std::size_t>(channel)]; }

std::optional<Channel> channelNamed(std::string_view name) {
  for (int i = 0; i < kChannelCount; ++i) {
    if (name == kChannels[i].name) return static_cast<Channel>(i);
  }
  return std::nullopt;
}

}  // namespace beam
