// SPDX-License-Identifier: Apache-2.0
#include "viewers/splat/splat_renderer.h"

#include <algorithm>
#include <chrono>

#include "core/render/sky_picture.h"
#include "viewers/splat/channel_picture.h"

namespace beam {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// What is shown, and what words about a pixel and the focus need.
std::vector<ChannelInfo> channelsFor(const SplatPicture& picture, const RendererAbilities& abilities) {
  std::vector<ChannelInfo> asked;
  const bool shown = picture.lack == Lack::None || picture.channel != picture.wanted;
  if (shown) asked.push_back(picture.channel);
  for (const char* id : {kAlphaChannel, kDepthChannel}) {
    const ChannelInfo& channel = channelOf(id);
    if (draws(abilities, channel) && (asked.empty() || asked.front() != channel)) asked.push_back(channel);
  }
  return asked;
}

}  // namespace

std::optional<Limits> fixedLimits(const SplatRequest& request, const ChannelInfo& channel) {
  if (!channel.false_color || isShare(channel)) return Limits{};
  return channel.quantity == Quantity::Length ? request.depth_limits : std::nullopt;
}

const Planes& valuesIn(const SplatPicture& picture, std::string_view channel) {
  static const Planes none;
  const RenderedChannel* found = channelIn(picture.rendered, channel);
  return found && found->values ? *found->values : none;
}

SplatRenderer::SplatRenderer(std::unique_ptr<SceneRenderer> renderer) : renderer_(std::move(renderer)) {}

void SplatRenderer::render(const SplatRequest& r, Progress& progress, const OnPicture& on_picture) {
  const auto start = Clock::now();
  SplatPicture frame;  // what all pictures of the request share
  frame.wanted = r.channel;
  frame.exposure_stops = r.exposure_stops;
  frame.lack = lackOf(r.channel, r.scene);
  const bool dark = r.channel.needs == ChannelNeeds::MaterialsAndLight && frame.lack != Lack::None;
  frame.channel = dark ? channelOf(kRgbChannel) : r.channel;
  frame.left_out = renderer_->load(r.scene, progress);
  if (frame.channel.id == kRelightChannel && lacksVisibility(r.scene, abilities()))
    frame.left_out.push_back("no visibility was baked: " + abilities().without_visibility);
  const std::optional<Limits> fixed = fixedLimits(r, frame.channel);
  frame.limits = fixed.value_or(Limits{});
  const bool seen = r.sky && r.scene.environment;
  Image<vec3> sky =
      seen ? skyPicture(r.camera, r.scene.lighting.environment, *r.scene.environment) : Image<vec3>();
  double milliseconds = 0;
  renderer_->draw(r.camera, channelsFor(frame, abilities()), progress, [&](RenderedPicture rendered) {
    SplatPicture picture = frame;
    picture.rendered = std::move(rendered);
    const RenderedChannel* shown = channelIn(picture.rendered, picture.channel.id);
    if (shown && !shown->values) {
      picture.sky = sky;
    } else {
      const Planes& values = valuesIn(picture, picture.channel.id);
      const Planes& alpha = valuesIn(picture, kAlphaChannel);
      if (!fixed) picture.limits = robustLimits(values.values);
      picture.pixels = channelPicture(
          picture.channel, values, alpha.empty() ? Planes(r.camera.width, r.camera.height, 1, 1.0f) : alpha,
          sky, {.exposure_stops = r.exposure_stops, .limits = picture.limits});
    }
    if (milliseconds == 0) milliseconds = millisecondsSince(start);
    picture.milliseconds = milliseconds;
    on_picture(std::move(picture));
  });
}

}  // namespace beam
