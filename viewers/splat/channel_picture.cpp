// SPDX-License-Identifier: Apache-2.0
#include "viewers/splat/channel_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "viewers/encode.h"

namespace beam {
namespace {

constexpr float kVisible = 1 / 255.0f;
constexpr vec3 kBackdrop(0.0110f, 0.0116f, 0.0130f);  // linear; sRGB 27 28 30

// Data shown as it is (0 black, 1 white), over the encoded backdrop.
u8vec4 overBackdrop(vec3 shown, float alpha) {
  static const vec3 backdrop = srgbFromLinear(kBackdrop);
  return u8vec4(u8vec3(glm::clamp(glm::mix(backdrop, shown, alpha), vec3(0), vec3(1)) * 255.0f + 0.5f), 255);
}

u8vec4 dataPixel(const GBuffer& g, const ChannelOptions& o, std::size_t i) {
  const float alpha = g.alpha.pixels[i];
  if (alpha < kVisible) return overBackdrop(vec3(0), 0);
  switch (o.channel) {
    case Channel::AmbientOcclusion:
      return overBackdrop(vec3(g.ambient_occlusion.pixels[i] / alpha), alpha);
    case Channel::Roughness:
      return overBackdrop(vec3(falseColor(g.roughness.pixels[i] / alpha, o.limits)) / 255.0f, alpha);
    case Channel::Normal:
      return overBackdrop(0.5f + 0.5f * g.normal_world.pixels[i], alpha);
    case Channel::Depth: {
      const float depth = g.depth_m.pixels[i];
      return depth > 0 ? overBackdrop(vec3(falseColor(depth, o.limits)) / 255.0f, 1)
                       : overBackdrop(vec3(0), 0);
    }
    default:
      return overBackdrop(vec3(0), 0);
  }
}

bool isLight(Channel c) { return c == Channel::Lit || c == Channel::Radiance || c == Channel::BaseColor; }

std::string triple(const char* what, vec3 v) {
  return fmt::format("{} {:.3f} {:.3f} {:.3f}", what, v.x, v.y, v.z);
}

}  // namespace

bool holds(const GBuffer& g, const Image<vec3>& lit, Channel channel) {
  switch (channel) {
    case Channel::Lit:
      return !lit.empty();
    case Channel::Radiance:
      return !g.radiance.empty();
    case Channel::BaseColor:
      return !g.base_color.empty();
    case Channel::AmbientOcclusion:
      return !g.ambient_occlusion.empty();
    case Channel::Roughness:
      return !g.roughness.empty();
    case Channel::Normal:
      return !g.normal_world.empty();
    case Channel::Depth:
      return !g.depth_m.empty();
  }
  return false;
}

Image<u8vec4> channelPicture(const GBuffer& g, const Image<vec3>& lit, const Image<vec3>& sky,
                             const ChannelOptions& o) {
  const int w = g.alpha.width, h = g.alpha.height;
  Image<u8vec4> picture(w, h, overBackdrop(vec3(0), 0), Encoding::Srgb);
  const bool held = holds(g, lit, o.channel);
  if (!held && sky.empty()) return picture;
  const float gain = std::exp2(o.exposure_stops);
  const SrgbEncoder& encode = SrgbEncoder::instance();
  parallelFor(h, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * w; i < end * w; ++i) {
      if (!isLight(o.channel)) {
        picture.pixels[i] = dataPixel(g, o, i);
        continue;
      }
      const float alpha = held ? g.alpha.pixels[i] : 0;
      vec3 light(0);
      if (held && o.channel == Channel::Lit) light = gain * lit.pixels[i];
      if (held && o.channel == Channel::BaseColor) light = gain * g.base_color.pixels[i];
      if (held && o.channel == Channel::Radiance && alpha > 0) {
        light = gain * linearFromSrgb(glm::max(g.radiance.pixels[i], vec3(0)));
      }
      const vec3 behind = sky.empty() ? kBackdrop : gain * sky.pixels[i];
      picture.pixels[i] = u8vec4(encode(light + (1 - alpha) * behind), 255);
    }
  });
  return picture;
}

std::string describePixel(const GBuffer& g, const Image<vec3>& lit, Channel channel, int x, int y) {
  const std::size_t i = g.alpha.index(x, y);
  const float alpha = g.alpha.pixels[i];
  if (alpha < kVisible) return "nothing here";
  if (!holds(g, lit, channel)) return fmt::format("alpha {:.2f}", alpha);
  std::string value;
  switch (channel) {
    case Channel::Lit:
      value = triple("linear", lit.pixels[i] / alpha);
      break;
    case Channel::Radiance:
      value = triple("sRGB", g.radiance.pixels[i] / alpha);
      break;
    case Channel::BaseColor:
      value = triple("linear", g.base_color.pixels[i] / alpha);
      break;
    case Channel::AmbientOcclusion:
      value = fmt::format("{:.3f}", g.ambient_occlusion.pixels[i] / alpha);
      break;
    case Channel::Roughness:
      value = fmt::format("{:.3f}", g.roughness.pixels[i] / alpha);
      break;
    case Channel::Normal:
      value = triple("x y z", g.normal_world.pixels[i]);
      break;
    case Channel::Depth:
      value = fmt::format("{:.4f} m", g.depth_m.pixels[i]);
      break;
  }
  return fmt::format("{} {} · alpha {:.2f}", infoOf(channel).title, value, alpha);
}

}  // namespace beam
