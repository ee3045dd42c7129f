// SPDX-License-Identifier: Apache-2.0
#include "viewers/image/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/color.h"

namespace beam {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr int kInside = 128;        // of a mask's 255
constexpr float kDarkened = 0.35f;  // what is not counted
constexpr std::size_t kRowsAPiece = 16;

enum class Kind { Colour, Direction, Share, Number };

Kind kindOf(const Picture& p) {
  if (p.encoding != Encoding::Data) return Kind::Colour;
  if (p.values.channels == 3) return Kind::Direction;
  return p.unit.empty() ? Kind::Share : Kind::Number;
}

std::string kindText(const Picture& p) {
  switch (kindOf(p)) {
    case Kind::Colour:
      return "colour";
    case Kind::Direction:
      return "a direction";
    case Kind::Share:
      return "a share of 1";
    case Kind::Number:
      return "a number in " + p.unit;
  }
  return {};
}

// Colours as the screen gets them, other numbers as they are.
vec3 shownAt(const Picture& p, std::size_t i) {
  const vec3 v(p.values.plane(0)[i], p.values.plane(1)[i], p.values.plane(2)[i]);
  if (p.encoding == Encoding::Data) return v;
  const vec3 clamped = glm::clamp(v, vec3(0), vec3(1));
  return p.encoding == Encoding::Linear ? srgbFromLinear(clamped) : clamped;
}

// Unit vectors, and zero where nothing is.
float angle_deg(vec3 a, vec3 b) {
  if (a == b) return a == vec3(0) ? kNothing : 0;
  if (a == vec3(0) || b == vec3(0)) return kNothing;
  // By atan2: acos of a dot product is coarse where the two agree.
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / kPi;
}

// What a pixel of both comes to, and the sum over channels of its squares.
struct Apart {
  float value = 0;
  double squares = 0;
};

Apart apartAt(const Picture& a, const Picture& b, Kind kind, std::size_t i) {
  if (kind == Kind::Colour) {
    const vec3 d = glm::abs(shownAt(a, i) - shownAt(b, i));
    return {(d.x + d.y + d.z) / 3, glm::dot(dvec3(d), dvec3(d))};
  }
  if (kind == Kind::Direction) return {angle_deg(shownAt(a, i), shownAt(b, i)), 0};
  const float x = a.values.plane(0)[i], y = b.values.plane(0)[i];
  const bool missing = (a.false_color && x == a.nothing) || (b.false_color && y == b.nothing);
  if (missing) return {kNothing, 0};
  const float d = std::abs(x - y);
  return {d, static_cast<double>(d) * static_cast<double>(d)};
}

bool inside(const Difference& d, std::size_t i) {
  return d.counted.empty() || d.counted.pixels[i] >= kInside;
}

bool counts(const Difference& d, std::size_t i) {
  return inside(d, i) && !std::isnan(d.map.values.values[i]);
}

std::string grouped(std::size_t n) {
  std::string text = std::to_string(n);
  for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3)
    text.insert(static_cast<std::size_t>(at), 1, ',');
  return text;
}

std::string unitOf(const Picture& a, Kind kind) { return kind == Kind::Direction ? "°" : a.unit; }

}  // namespace

std::string incomparable(const Picture& a, const Picture& b) {
  if (a.values.width != b.values.width || a.values.height != b.values.height) {
    return fmt::format(
        "A is {} x {} pixels and B {} x {}: there is a difference only of pictures of one size.",
        a.values.width, a.values.height, b.values.width, b.values.height);
  }
  const Kind kind = kindOf(a);
  if (kind != kindOf(b) || (kind != Kind::Colour && a.unit != b.unit)) {
    return fmt::format("A shows {} and B {}: there is a difference only of pictures of one kind.",
                       kindText(a), kindText(b));
  }
  return {};
}

Difference differenceOf(const Picture& a, const Picture& b, Image<std::uint8_t> mask) {
  if (const std::string why = incomparable(a, b); !why.empty()) throw Error(Error::Kind::Data, why);
  const int w = a.values.width, h = a.values.height;
  if (!mask.empty() && (mask.width != w || mask.height != h)) {
    throw Error(Error::Kind::Data, fmt::format("The mask is {} x {} pixels and the pictures are {} x {}.",
                                               mask.width, mask.height, w, h));
  }
  const Kind kind = kindOf(a);
  Difference d;
  d.counted = std::move(mask);
  d.map = Picture{.label = {},
                  .values = Planes(w, h, 1),
                  .encoding = Encoding::Data,
                  .false_color = true,
                  .nothing = kNothing,
                  .unit = unitOf(a, kind),
                  .mask = {}};
  std::vector<double> squares(d.map.values.planeSize());
  parallelFor(static_cast<std::size_t>(h), kRowsAPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * w; i < end * w; ++i) {
      const Apart apart = apartAt(a, b, kind, i);
      d.map.values.values[i] = apart.value;
      squares[i] = apart.squares;
    }
  });
  double sum = 0, sum_of_squares = 0;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (!counts(d, i)) continue;
    ++d.pixels;
    sum += d.map.values.values[i];
    sum_of_squares += squares[i];
  }
  if (d.pixels == 0) return d;
  d.mean = sum / static_cast<double>(d.pixels);
  d.identical = sum == 0;
  const int channels = kind == Kind::Colour ? 3 : 1;
  if ((kind == Kind::Colour || kind == Kind::Share) && !d.identical)
    d.psnr_db = -10 * std::log10(sum_of_squares / (channels * static_cast<double>(d.pixels)));
  return d;
}

Limits limitsOf(const Difference& d) {
  std::vector<float> counted;
  counted.reserve(d.pixels);
  for (std::size_t i = 0; i < d.map.values.values.size(); ++i) {
    if (counts(d, i)) counted.push_back(d.map.values.values[i]);
  }
  return {0, robustLimits(counted).high};
}

Image<u8vec4> displayed(const Difference& d, const Limits& limits) {
  Image<u8vec4> out = displayed(d.map, 0, limits);
  if (d.counted.empty()) return out;
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    if (!inside(d, i)) out.pixels[i] = u8vec4(u8vec3(kDarkened * vec3(out.pixels[i])), 255);
  }
  return out;
}

std::string describe(const Difference& d) {
  const std::string where = d.counted.empty() ? "all pixels" : "the mask";
  if (d.pixels == 0) return fmt::format("no pixel to compare in {}", where);
  const std::string over =
      fmt::format("over {}, {} {}", where, grouped(d.pixels), d.pixels == 1 ? "pixel" : "pixels");
  if (d.identical) return "identical · " + over;
  const std::string& unit = d.map.unit;
  const std::string mean =
      fmt::format("mean {:.4g}{}{}", d.mean, unit.empty() || unit == "°" ? "" : " ", unit);
  return (d.psnr_db ? fmt::format("PSNR {:.2f} dB · ", *d.psnr_db) : std::string()) + mean + " · " + over;
}

}  // namespace beam
