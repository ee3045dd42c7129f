// SPDX-License-Identifier: Apache-2.0
#include "viewers/image/picture.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/parallel.h"
#include "viewers/encode.h"

namespace beam {
namespace {

vec3 valueAt(const Picture& p, std::size_t i) {
  if (p.values.channels == 1) return vec3(p.values.plane(0)[i]);
  return {p.values.plane(0)[i], p.values.plane(1)[i], p.values.plane(2)[i]};
}

u8vec3 asByte(vec3 shown) { return u8vec3(glm::clamp(shown, vec3(0), vec3(1)) * 255.0f + 0.5f); }

template <class T>
Picture planesOf(const Image<T>& image, std::string label, float scale) {
  constexpr int channels = sizeof(T) / sizeof(T{}[0]);
  Picture p{.label = std::move(label),
            .values = Planes(image.width, image.height, channels),
            .encoding = image.encoding,
            .unit = {},
            .mask = {}};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < channels; ++c) p.values.plane(c)[i] = scale * static_cast<float>(image.pixels[i][c]);
  }
  return p;
}

}  // namespace

Picture pictureOf(const Image<u8vec3>& photo, std::string label) {
  Picture p = planesOf(photo, std::move(label), 1 / 255.0f);
  p.encoding = Encoding::Srgb;
  return p;
}

Picture pictureOf(const Image<vec3>& image, std::string label) {
  return planesOf(image, std::move(label), 1);
}

Picture pictureOf(const Image<std::uint8_t>& mask, std::string label) {
  Picture p{.label = std::move(label),
            .values = Planes(mask.width, mask.height, 1),
            .encoding = Encoding::Data,
            .unit = {},
            .mask = {}};
  for (std::size_t i = 0; i < mask.pixels.size(); ++i)
    p.values.values[i] = static_cast<float>(mask.pixels[i]) / 255;
  return p;
}

Picture pictureOf(const Image<float>& image, std::string label) {
  Picture p{.label = std::move(label),
            .values = Planes(image.width, image.height, 1),
            .encoding = Encoding::Data,
            .unit = {},
            .mask = {}};
  p.values.values = image.pixels;
  return p;
}

Image<u8vec4> displayed(const Picture& p, float exposure_stops, const Limits& limits) {
  Image<u8vec4> out(p.values.width, p.values.height, u8vec4(0, 0, 0, 255), Encoding::Srgb);
  const float gain = std::exp2(exposure_stops);
  const SrgbEncoder& encode = SrgbEncoder::instance();
  const auto shown = [&](vec3 v) -> u8vec3 {
    if (p.false_color) {
      return v.x == p.nothing || std::isnan(v.x) ? u8vec3(27, 28, 30) : falseColor(v.x, limits);
    }
    switch (p.encoding) {
      case Encoding::Srgb:
        return exposure_stops == 0 ? asByte(v) : encode(gain * linearFromSrgb(v));
      case Encoding::Linear:
        return encode(gain * v);
      case Encoding::Data:
        break;
    }
    if (p.values.channels == 1) return asByte(v);
    return v == vec3(0) ? u8vec3(27, 28, 30) : asByte(0.5f + 0.5f * v);
  };
  parallelFor(out.height, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * out.width; i < end * out.width; ++i)
      out.pixels[i] = u8vec4(shown(valueAt(p, i)), 255);
  });
  return out;
}

std::string describePixel(const Picture& p, int x, int y) {
  const vec3 v = valueAt(p, static_cast<std::size_t>(y) * p.values.width + x);
  const std::string unit = p.unit.empty() ? "" : " " + p.unit;
  if (p.encoding == Encoding::Data) {
    if (p.values.channels == 1) return fmt::format("{:.4f}{}", v.x, unit);
    return fmt::format("{:.3f} {:.3f} {:.3f}{}", v.x, v.y, v.z, unit);
  }
  const vec3 linear = p.encoding == Encoding::Srgb ? linearFromSrgb(v) : v;
  const vec3 encoded = p.encoding == Encoding::Srgb ? v : srgbFromLinear(glm::clamp(v, vec3(0), vec3(1)));
  const ivec3 bytes(255.0f * encoded + 0.5f);
  return fmt::format("linear {:.4f} {:.4f} {:.4f} · sRGB {} {} {}", linear.x, linear.y, linear.z, bytes.x,
                     bytes.y, bytes.z);
}

}  // namespace beam
