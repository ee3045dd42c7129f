// SPDX-License-Identifier: Apache-2.0
#include "core/scene/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/math/color.h"
#include "core/math/sh.h"

namespace beam {
namespace {

vec3 turned(vec3 d, float yaw) {
  const float c = std::cos(yaw), s = std::sin(yaw);
  return {c * d.x + s * d.z, d.y, -s * d.x + c * d.z};
}

// Solid angle of a texel in row y: dphi * (sin of upper latitude - sin of lower latitude), exact.
float texelSolidAngle(int width, int height, int y) {
  const float top = std::sin(kPi * (0.5f - static_cast<float>(y) / height));
  const float bottom = std::sin(kPi * (0.5f - static_cast<float>(y + 1) / height));
  return 2 * kPi / width * (top - bottom);
}

vec3 texelDirection(int width, int height, int x, int y) {
  return directionFromLatLong({(x + 0.5f) / width, (y + 0.5f) / height});
}

int upperIndex(const float* cdf, int count, float u) {
  const int i = static_cast<int>(std::upper_bound(cdf, cdf + count + 1, u) - cdf) - 1;
  return std::clamp(i, 0, count - 1);
}

}  // namespace

vec2 latLongFromDirection(vec3 d) {
  return {0.5f - std::atan2(d.x, d.z) / (2 * kPi), 0.5f - std::asin(std::clamp(d.y, -1.0f, 1.0f)) / kPi};
}

vec3 directionFromLatLong(vec2 uv) {
  const float longitude = (0.5f - uv.x) * 2 * kPi, latitude = (0.5f - uv.y) * kPi;
  return {std::cos(latitude) * std::sin(longitude), std::sin(latitude),
          std::cos(latitude) * std::cos(longitude)};
}

vec3 lookUp(const Image<vec3>& r, vec2 uv) {
  const float x = uv.x * r.width - 0.5f, y = std::clamp(uv.y * r.height - 0.5f, 0.0f, r.height - 1.0f);
  // The floor, and the column around the seam, in a few instructions: shading asks three times a pixel.
  const int cut = static_cast<int>(x), x0 = std::clamp(cut - (x < cut ? 1 : 0), -1, r.width - 1);
  const int y0 = static_cast<int>(y), y1 = std::min(y0 + 1, r.height - 1);
  const int left = x0 < 0 ? r.width - 1 : x0, right = x0 + 1 == r.width ? 0 : x0 + 1;
  return glm::mix(glm::mix(r(left, y0), r(right, y0), x - x0), glm::mix(r(left, y1), r(right, y1), x - x0),
                  y - y0);
}

vec3 radianceFrom(const Environment& e, vec3 direction) {
  return e.gain * lookUp(e.radiance, turned(direction, -e.yaw_rad));
}

std::string shapeDoubt(const Image<vec3>& radiance, const std::string& name) {
  if (radiance.width == 2 * radiance.height) return {};
  return fmt::format(
      "\"{}\": expected a panorama twice as wide as high, found {} x {}: it is stretched over the whole "
      "sphere",
      name, radiance.width, radiance.height);
}

// Resizing filters leave such negative values beside bright texels; they say nothing of a panorama.
constexpr float kFilterDip = 1e-3f;

Environment makeEnvironment(Image<vec3> radiance) {
  if (radiance.empty()) throw Error(Error::Kind::Data, "the panorama is empty: expected at least one pixel");
  std::size_t not_finite = 0, negative = 0;
  for (vec3& p : radiance.pixels) {
    for (int c = 0; c < 3; ++c) {
      if (std::isfinite(p[c]) && p[c] >= 0) continue;
      if (!std::isfinite(p[c]))
        ++not_finite;
      else if (p[c] <= -kFilterDip)
        ++negative;
      p[c] = 0;
    }
  }
  if (not_finite + negative > 0) {
    logWarning(
        "panorama: expected finite radiance of at least 0, found {} values that are not finite and {} below "
        "0; they count as black",
        not_finite, negative);
  }
  radiance.encoding = Encoding::Linear;
  return {std::move(radiance)};
}

vec3 meanRadiance(const Environment& e) {
  const Image<vec3>& r = e.radiance;
  dvec3 sum(0);
  for (int y = 0; y < r.height; ++y) {
    dvec3 row(0);
    for (int x = 0; x < r.width; ++x) row += dvec3(r(x, y));
    sum += row * static_cast<double>(texelSolidAngle(r.width, r.height, y));
  }
  return e.gain * vec3(sum / (4.0 * kPi));
}

vec3 brightestDirection(const Environment& e) {
  const Image<vec3>& r = e.radiance;
  const auto brightest = std::max_element(r.pixels.begin(), r.pixels.end(), [](const vec3& a, const vec3& b) {
    return luminance(a) < luminance(b);
  });
  const auto i = static_cast<int>(brightest - r.pixels.begin());
  return turned(texelDirection(r.width, r.height, i % r.width, i / r.width), e.yaw_rad);
}

EnvironmentSampler::EnvironmentSampler(const Environment& e, float yaw_rad, float gain)
    : width_(e.radiance.width),
      height_(e.radiance.height),
      yaw_rad_(e.yaw_rad + yaw_rad),
      radiance_(e.radiance) {
  for (vec3& p : radiance_.pixels) p *= e.gain * gain;
  row_cdf_.assign(height_ + 1, 0);
  texel_cdf_.assign(static_cast<std::size_t>(height_) * (width_ + 1), 0);
  pdf_.assign(radiance_.pixels.size(), 0);
  double total = 0;
  std::vector<double> rowSum(height_);
  for (int y = 0; y < height_; ++y) {
    float* cdf = &texel_cdf_[static_cast<std::size_t>(y) * (width_ + 1)];
    const double solidAngle = texelSolidAngle(width_, height_, y);
    double sum = 0;
    for (int x = 0; x < width_; ++x) {
      sum += luminance(radiance_(x, y)) * solidAngle;
      cdf[x + 1] = static_cast<float>(sum);
    }
    for (int x = 1; x <= width_; ++x)
      cdf[x] = sum > 0 ? static_cast<float>(cdf[x] / sum) : static_cast<float>(x) / width_;
    rowSum[y] = sum;
    total += sum;
  }
  double running = 0;
  for (int y = 0; y < height_; ++y) {
    // A black panorama is drawn uniformly.
    running += total > 0 ? rowSum[y] / total : texelSolidAngle(width_, height_, y) / (4.0 * kPi);
    row_cdf_[y + 1] = static_cast<float>(running);
    for (int x = 0; x < width_; ++x) {
      pdf_[radiance_.index(x, y)] =
          total > 0 ? static_cast<float>(luminance(radiance_(x, y)) / total) : 1 / (4 * kPi);
    }
  }
}

EnvironmentSampler::Sample EnvironmentSampler::sample(float u1, float u2) const {
  const int y = upperIndex(row_cdf_.data(), height_, u1);
  const float inRow = (u1 - row_cdf_[y]) / std::max(row_cdf_[y + 1] - row_cdf_[y], 1e-20f);
  const float* cdf = &texel_cdf_[static_cast<std::size_t>(y) * (width_ + 1)];
  const int x = upperIndex(cdf, width_, u2);
  const float inTexel = (u2 - cdf[x]) / std::max(cdf[x + 1] - cdf[x], 1e-20f);
  // Uniform in solid angle inside the texel: linear in the sine of the latitude.
  const float top = std::sin(kPi * (0.5f - static_cast<float>(y) / height_));
  const float bottom = std::sin(kPi * (0.5f - static_cast<float>(y + 1) / height_));
  const float sine = std::clamp(top + (bottom - top) * std::clamp(inRow, 0.0f, 1.0f), -1.0f, 1.0f);
  const float longitude = (0.5f - (x + std::clamp(inTexel, 0.0f, 1.0f)) / width_) * 2 * kPi;
  const float cosine = std::sqrt(std::max(0.0f, 1 - sine * sine));
  const vec3 d(cosine * std::sin(longitude), sine, cosine * std::cos(longitude));
  return {turned(d, yaw_rad_), radiance_(x, y), pdf_[radiance_.index(x, y)]};
}

EnvironmentSampler::Sample EnvironmentSampler::at(vec3 direction) const {
  const vec2 uv = latLongFromDirection(turned(direction, -yaw_rad_));
  const int x = std::clamp(static_cast<int>(uv.x * width_), 0, width_ - 1);
  const int y = std::clamp(static_cast<int>(uv.y * height_), 0, height_ - 1);
  return {direction, radiance_(x, y), pdf_[radiance_.index(x, y)]};
}

float EnvironmentSampler::pdf(vec3 direction) const { return at(direction).pdf; }

vec3 EnvironmentSampler::texelRadiance(vec3 direction) const { return at(direction).radiance; }

std::array<vec3, 9> irradianceSh(const Environment& e) {
  const Image<vec3>& r = e.radiance;
  std::array<dvec3, 9> sum{};
  for (int y = 0; y < r.height; ++y) {
    const double solidAngle = texelSolidAngle(r.width, r.height, y);
    for (int x = 0; x < r.width; ++x) {
      const auto basis = shBasis(turned(texelDirection(r.width, r.height, x, y), e.yaw_rad));
      for (int k = 0; k < 9; ++k) sum[k] += dvec3(r(x, y)) * (basis[k] * solidAngle);
    }
  }
  // Cosine lobe: A_0 = pi, A_1 = 2 pi / 3, A_2 = pi / 4.
  std::array<vec3, 9> sh;
  for (int k = 0; k < 9; ++k) {
    const float lobe = k == 0 ? kPi : k < 4 ? 2 * kPi / 3 : kPi / 4;
    sh[k] = e.gain * lobe * vec3(sum[k]);
  }
  return sh;
}

vec3 irradiance(const std::array<vec3, 9>& sh, vec3 normal) {
  const auto basis = shBasis(normal);
  vec3 e(0);
  for (int k = 0; k < 9; ++k) e += basis[k] * sh[k];
  return glm::max(e, vec3(0));
}

}  // namespace beam
