// SPDX-License-Identifier: Apache-2.0
#include "core/render/light_transfer.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/brdf.h"
#include "core/render/prepared_light.h"
#include "core/scene/environment.h"

namespace beam {
namespace {

constexpr int kWidth = 64, kSourceWidth = 128;
constexpr int kLobes = 33;  // roughness 0 .. 1
constexpr int kLobeSteps = 2048;

// How much of each band a lobe of roughness i / (kLobes - 1) leaves: the mean of P_l over it. The lobe is
// that of the prefiltered levels: D(h) (n.l) about n = v (Karis 2013).
using Bands = std::array<float, 4>;

Bands bandsOf(float roughness) {
  const float alpha = ggxAlpha(std::max(roughness, kLeastRoughness));
  std::array<double, 4> sums{};
  for (int i = 0; i < kLobeSteps; ++i) {
    // Steps in the square of the angle's share: most of a narrow lobe is near 0.
    const double t = (i + 0.5) / kLobeSteps, theta = kPi / 2 * t * t, c = std::cos(theta);
    const double width = std::sin(theta) * t;
    const double lobe = ggxDistribution(std::sqrt(0.5f * (1 + static_cast<float>(c))), alpha) * c * width;
    const std::array<double, 4> legendre = {1, c, 0.5 * (3 * c * c - 1), 0.5 * (5 * c * c - 3) * c};
    for (int l = 0; l < 4; ++l) sums[l] += lobe * legendre[l];
  }
  Bands bands;
  for (int l = 0; l < 4; ++l) bands[l] = static_cast<float>(sums[l] / sums[0]);
  return bands;
}

const std::array<Bands, kLobes>& lobeTable() {
  static const std::array<Bands, kLobes> table = [] {
    std::array<Bands, kLobes> t;
    for (int i = 0; i < kLobes; ++i) t[i] = bandsOf(static_cast<float>(i) / (kLobes - 1));
    return t;
  }();
  return table;
}

// `tables` at a direction, bilinear across the seam, each texel's weight to body(texel, weight).
template <class Body>
void forCorners(const TransferTables& t, vec3 direction, Body&& body) {
  const vec2 uv = latLongFromDirection(direction);
  const float x = uv.x * t.width - 0.5f, y = std::clamp(uv.y * t.height - 0.5f, 0.0f, t.height - 1.0f);
  const int x0 = static_cast<int>(std::floor(x)), y0 = std::min(static_cast<int>(y), t.height - 2);
  const float fx = x - x0, fy = y - y0;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const int column = (x0 + i + t.width) % t.width;
      body(t.texels[static_cast<std::size_t>(y0 + j) * t.width + column],
           (i == 0 ? 1 - fx : fx) * (j == 0 ? 1 - fy : fy));
    }
  }
}

}  // namespace

TransferTables prepareTransfer(const Image<vec3>& panorama, const Progress& progress) {
  const Image<vec3> source = reducedPanorama(panorama, kSourceWidth, kSourceWidth / 2, progress);
  struct Ray {
    vec3 direction;
    std::array<vec3, kShCount> light;  // L Y_k dw
  };
  std::vector<Ray> rays;
  for (int y = 0; y < source.height; ++y) {
    const double top = std::sin(kPi * (0.5 - static_cast<double>(y) / source.height));
    const double bottom = std::sin(kPi * (0.5 - (y + 1.0) / source.height));
    const auto angle = static_cast<float>(2 * kPi / source.width * (top - bottom));
    for (int x = 0; x < source.width; ++x) {
      Ray ray{directionFromLatLong({(x + 0.5f) / source.width, (y + 0.5f) / source.height}), {}};
      const auto basis = shBasis(ray.direction);
      for (int k = 0; k < kShCount; ++k) ray.light[k] = basis[k] * angle * source(x, y);
      rays.push_back(ray);
    }
  }
  TransferTables t{kWidth, kWidth / 2, {}};
  t.texels.resize(static_cast<std::size_t>(t.width) * t.height);
  parallelFor(t.texels.size(), 16, [&](std::size_t begin, std::size_t end) {
    if (progress.stopRequested()) return;
    for (std::size_t i = begin; i < end; ++i) {
      const int x = static_cast<int>(i) % t.width, y = static_cast<int>(i) / t.width;
      const vec3 n = directionFromLatLong({(x + 0.5f) / t.width, (y + 0.5f) / t.height});
      std::array<vec3, kShCount> sum{};
      for (const Ray& ray : rays) {
        const float c = glm::dot(n, ray.direction);
        if (c <= 0) continue;
        for (int k = 0; k < kShCount; ++k) sum[k] += c * ray.light[k];
      }
      t.texels[i] = sum;
    }
  });
  progress.check();
  return t;
}

vec3 seenIrradiance(const TransferTables& tables, vec3 normal, const Visibility& v, vec3 open) {
  std::array<vec3, kShCount> t{};
  forCorners(tables, normal, [&](const std::array<vec3, kShCount>& texel, float weight) {
    for (int k = 0; k < kShCount; ++k) t[k] += weight * texel[k];
  });
  // What is missing from V = 1, so that an open surface has E(n) to the bit.
  vec3 sum = (v[0] - 0.5f / kShC0) * t[0];
  for (int k = 1; k < kShCount; ++k) sum += v[k] * t[k];
  return glm::clamp(open + sum, vec3(0), open);
}

float seenHighlight(const Visibility& v, vec3 mirror, float roughness) {
  const float at = std::clamp(roughness, 0.0f, 1.0f) * (kLobes - 1);
  const int below = std::min(static_cast<int>(at), kLobes - 2);
  const Bands &a = lobeTable()[below], &b = lobeTable()[below + 1];
  const auto basis = shBasis(mirror);
  float sum = 0.5f;
  for (int l = 0, k = 0; l < 4; ++l) {
    const float band = a[l] + (at - static_cast<float>(below)) * (b[l] - a[l]);
    for (; k < (l + 1) * (l + 1); ++k) sum += band * basis[k] * v[k];
  }
  return std::clamp(sum, 0.0f, 1.0f);
}

}  // namespace beam
