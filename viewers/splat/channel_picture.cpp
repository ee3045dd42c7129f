// SPDX-License-Identifier: Apache-2.0
#include "viewers/splat/channel_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/scene/gbuffer.h"
#include "viewers/encode.h"

namespace beam {
namespace {

// Data shown as it is (0 black, 1 white), over the encoded backdrop.
u8vec4 overBackdrop(vec3 shown, float alpha) {
  static const vec3 backdrop = srgbFromLinear(kBackdrop);
  return u8vec4(u8vec3(glm::clamp(glm::mix(backdrop, shown, alpha), vec3(0), vec3(1)) * 255.0f + 0.5f), 255);
}

vec3 triple(const Planes& p, std::size_t i) { return {p.plane(0)[i], p.plane(1)[i], p.plane(2)[i]}; }

// Of the surface, where alpha is at least kVisibleAlpha.
float surfaceValue(const ChannelInfo& channel, float value, float alpha) {
  return channel.times_alpha ? value / alpha : value;
}

u8vec4 dataPixel(const ChannelInfo& channel, const Planes& values, const Limits& limits, float alpha,
                 std::size_t i) {
  if (alpha < std::max(kVisibleAlpha, channel.least_alpha)) return overBackdrop(vec3(0), 0);
  if (channel.quantity == Quantity::Direction) return overBackdrop(0.5f + 0.5f * triple(values, i), alpha);
  const float value = surfaceValue(channel, values.values[i], alpha);
  const vec3 shown = channel.false_color ? vec3(falseColor(value, limits)) / 255.0f : vec3(value);
  return overBackdrop(shown, channel.least_alpha > kVisibleAlpha ? 1 : alpha);
}

std::string inWords(const char* what, vec3 v) {
  return fmt::format("{} {:.3f} {:.3f} {:.3f}", what, v.x, v.y, v.z);
}

std::string inWords(const ChannelInfo& channel, const Planes& values, float alpha, std::size_t i) {
  switch (channel.quantity) {
    case Quantity::Color: {
      const vec3 v = triple(values, i);
      return inWords(channel.encoding == Encoding::Srgb ? "sRGB" : "linear",
                     channel.times_alpha ? v / alpha : v);
    }
    case Quantity::Direction:
      return inWords("x y z", triple(values, i));
    case Quantity::Length:
      return fmt::format("{:.4f} {}", surfaceValue(channel, values.values[i], alpha), channel.unit);
    case Quantity::Scalar: {
      const float v = surfaceValue(channel, values.values[i], alpha);
      return channel.unit.empty() ? fmt::format("{:.3f}", v) : fmt::format("{:.3f} {}", v, channel.unit);
    }
  }
  return {};
}

}  // namespace

Image<u8vec4> channelPicture(const ChannelInfo& channel, const Planes& values, const Planes& alpha,
                             const Image<vec3>& sky, const ChannelOptions& o) {
  const int w = alpha.width, h = alpha.height;
  const bool held = !values.empty();
  Image<u8vec4> picture(w, h, overBackdrop(vec3(0), 0), Encoding::Srgb);
  if (!held && sky.empty()) return picture;
  const float gain = std::exp2(o.exposure_stops);
  const SrgbEncoder& encode = SrgbEncoder::instance();
  const bool color = channel.quantity == Quantity::Color;
  parallelFor(h, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * w; i < end * w; ++i) {
      if (!color) {
        if (held) picture.pixels[i] = dataPixel(channel, values, o.limits, alpha.values[i], i);
        continue;
      }
      const float cover = held ? alpha.values[i] : 0;
      if (cover == 0 && sky.empty()) continue;
      vec3 light = held ? triple(values, i) : vec3(0);
      if (channel.encoding == Encoding::Srgb) light = linearFromSrgb(glm::max(light, vec3(0)));
      const vec3 behind = sky.empty() ? kBackdrop : gain * sky.pixels[i];
      picture.pixels[i] = u8vec4(encode(gain * light + (1 - cover) * behind), 255);
    }
  });
  return picture;
}

std::string describePixel(const ChannelInfo& channel, const Planes& values, const Planes& alpha, int x,
                          int y) {
  const std::size_t i = static_cast<std::size_t>(y) * alpha.width + x;
  const float cover = alpha.values[i];
  if (cover < kVisibleAlpha) return "nothing here";
  if (values.empty()) return fmt::format("alpha {:.2f}", cover);
  return fmt::format("{} {} · alpha {:.2f}", channel.title, inWords(channel, values, cover, i), cover);
}

}  // namespace beam
