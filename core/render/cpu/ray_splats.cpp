// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu/ray_splats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/rng.h"
#include "core/render/kernels/response.h"

namespace beam {
namespace {

constexpr float kMinScale_m = 1e-6f;
constexpr float kMargin = 1e-5f;  // of the scene's size: some 100 roundings of a coordinate

// The ellipsoid's tight box: half extent k sqrt(Sigma_ee).
RaySplat splatOf(const GaussianCloud& cloud, std::size_t i, float cut_response) {
  RaySplat s{};
  const mat3 axes = glm::mat3_cast(cloud.rotation[i]);
  const vec3 scale = glm::max(cloud.scale_m[i], vec3(kMinScale_m));
  s.center = cloud.position_m[i];
  s.opacity = cloud.opacity[i];
  s.cut2 = static_cast<float>(2 * std::log(static_cast<double>(s.opacity) / cut_response));
  vec3 variance(0);
  for (int k = 0; k < 3; ++k) {
    for (int c = 0; c < 3; ++c) {
      s.canonical[3 * k + c] = axes[k][c] / scale[k];
      variance[c] += axes[k][c] * axes[k][c] * scale[k] * scale[k];
    }
  }
  const vec3 half = glm::sqrt(variance * s.cut2);
  s.low = s.center - half;
  s.high = s.center + half;
  return s;
}

void growByRounding(std::vector<RaySplat>& splats) {
  float size = 0;
  for (const RaySplat& s : splats) {
    for (int k = 0; k < 3; ++k) size = std::max({size, std::abs(s.low[k]), std::abs(s.high[k])});
  }
  for (RaySplat& s : splats) {
    s.margin_m = kMargin * size;
    s.low -= s.margin_m;
    s.high += s.margin_m;
  }
}

}  // namespace

std::vector<std::uint32_t> metSplats(const TracerDesc& desc, const GaussianCloud& cloud) {
  std::vector<std::uint32_t> met;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.opacity[i] > desc.cut_response) met.push_back(static_cast<std::uint32_t>(i));
  return met;
}

std::vector<RaySplat> raySplats(const TracerDesc& desc, const GaussianCloud& cloud) {
  if (!(desc.cut_response > 0) || !(desc.threshold >= 0)) {
    throw Error(Error::Kind::Bug,
                fmt::format("a tracer needs a cut above 0 and a threshold of 0 or more, not {} and {}",
                            desc.cut_response, desc.threshold));
  }
  std::vector<RaySplat> splats;
  const std::vector<std::uint32_t> met = metSplats(desc, cloud);
  splats.reserve(met.size());
  for (const std::uint32_t i : met) splats.push_back(splatOf(cloud, i, desc.cut_response));
  growByRounding(splats);
  return splats;
}

bool endsIn(std::uint32_t splat, float units, std::uint64_t draw) {
  const float u = static_cast<float>(mixBits(draw ^ splat * 0x9e3779b97f4a7c15ull) >> 40) * 0x1p-24f;
  return u < std::min(units / scalar::kAlphaUnits, kMostAlpha);
}

std::uint64_t absorbanceUnits(float units) {
  const float alpha = std::min(units / scalar::kAlphaUnits, kMostAlpha);
  return static_cast<std::uint64_t>(-std::log1p(-alpha) * scalar::kAlphaUnits + 0.5f);
}

float transmittanceOf(std::uint64_t absorbance_units) {
  if (absorbance_units > kOpaqueUnits) return 0;
  return std::exp(-static_cast<float>(absorbance_units) / scalar::kAlphaUnits);
}

std::uint64_t freeAlphaUnits(const TracerDesc& desc) {
  return static_cast<std::uint64_t>(std::floor(static_cast<double>(desc.threshold) * scalar::kAlphaUnits));
}

}  // namespace beam
