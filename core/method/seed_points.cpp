// SPDX-License-Identifier: Apache-2.0
#include "core/method/seed_points.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/scene/visual_hull.h"

namespace beam {
namespace {

constexpr float kHullCell_m = 0.004f;
constexpr float kNormalRadius_m = 0.015f;

// Outward direction of the hull at a surface point: the mean of directions whose probe lies outside.
vec3 outwardNormal(const VisualHull& hull, vec3 x) {
  constexpr int kProbes = 32;
  vec3 sum(0);
  for (int i = 0; i < kProbes; ++i) {  // Fibonacci sphere
    const float z = 1 - (2 * i + 1.0f) / kProbes, r = std::sqrt(1 - z * z), phi = 2.39996323f * i;
    const vec3 d(r * std::cos(phi), r * std::sin(phi), z);
    if (!hull.contains(x + kNormalRadius_m * d)) sum += d;
  }
  const float length = glm::length(sum);
  return length > 1e-3f ? sum / length : vec3(0);
}

// Mean of the photographs at the point, weighted towards views that face it; occlusion is left to the fit.
u8vec3 colorFromViews(std::span<const FrameView> views, vec3 x, vec3 normal) {
  dvec3 sum(0);
  double weights = 0;
  for (const FrameView& v : views) {
    const dvec3 t = v.camera.camera_from_world * dvec3(x);
    if (t.z <= 0.01) continue;
    const dvec2 p = project(v.camera.intrinsics, t);
    if (!(p.x >= 0 && p.y >= 0 && p.x < v.photo.width && p.y < v.photo.height)) continue;
    const double facing = glm::dot(glm::normalize(centerOf(v.camera) - dvec3(x)), dvec3(normal));
    const double weight = normal == vec3(0) ? 1.0 : std::pow(std::max(0.0, facing), 4.0) + 1e-4;
    sum += weight * dvec3(v.photo(static_cast<int>(p.x), static_cast<int>(p.y)));
    weights += weight;
  }
  return weights > 0 ? u8vec3(glm::clamp(sum / weights + 0.5, 0.0, 255.0)) : u8vec3(128);
}

// `count` of `total` indices, drawn without replacement, in rising order.
std::vector<std::size_t> subset(std::size_t total, std::size_t count, int seed) {
  std::vector<std::pair<std::uint64_t, std::size_t>> keyed(total);
  const RandomStream random(seed, 0x5eedu);
  for (std::size_t i = 0; i < total; ++i) keyed[i] = {random.bits(i), i};
  const std::size_t kept = std::min(count, total);
  std::nth_element(keyed.begin(), keyed.begin() + static_cast<std::ptrdiff_t>(kept), keyed.end());
  std::vector<std::size_t> chosen(kept);
  for (std::size_t i = 0; i < kept; ++i) chosen[i] = keyed[i].second;
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace

PointCloud seedPoints(std::span<const FrameView> views, const PointCloud& seed_points, int count, int seed,
                      Progress& progress) {
  progress.expect(2);
  const VisualHull hull(views);
  const std::vector<vec3> surface = hull.surfaceCells(kHullCell_m, progress);
  progress.step();
  PointCloud out;
  if (surface.empty()) {
    if (seed_points.position_m.empty()) {
      throw Error(
          Error::Kind::Data,
          "no seed: expected masks whose visual hull is not empty, or a seed point cloud; found neither. "
          "Add masks/ or points3D.ply to the capture");
    }
    const bool colored = seed_points.color.size() == seed_points.position_m.size();
    for (const std::size_t i : subset(seed_points.position_m.size(), static_cast<std::size_t>(count), seed)) {
      const vec3 x = seed_points.position_m[i];
      out.position_m.push_back(x);
      out.color.push_back(colored ? seed_points.color[i] : colorFromViews(views, x, vec3(0)));
    }
    progress.step();
    return out;
  }
  const std::vector<std::size_t> chosen = subset(surface.size(), static_cast<std::size_t>(count), seed);
  out.position_m.resize(chosen.size());
  out.color.resize(chosen.size());
  const RandomStream jitter(seed, 0x717e5u);
  parallelFor(chosen.size(), 256, [&](std::size_t begin, std::size_t end) {
    if (progress.stopRequested()) return;
    for (std::size_t i = begin; i < end; ++i) {
      const vec3 offset(jitter.uniform(3 * i), jitter.uniform(3 * i + 1), jitter.uniform(3 * i + 2));
      const vec3 x = surface[chosen[i]] + kHullCell_m * (offset - 0.5f);
      const vec3 n = outwardNormal(hull, x);
      out.position_m[i] = x;
      out.color[i] = colorFromViews(views, x, n);
    }
  });
  progress.step();
  return out;
}

}  // namespace beam
