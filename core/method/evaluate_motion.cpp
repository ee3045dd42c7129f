// SPDX-License-Identifier: Apache-2.0
#include "core/method/evaluate_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/math/knn.h"
#include "core/math/sh.h"
#include "core/math/statistics.h"

namespace beam {
namespace {

constexpr double kTrackedShare = 0.25;
constexpr std::size_t kFewestPoints = 50;
constexpr float kOpaque = 0.5f;
constexpr std::size_t kPatch = 13;  // true points around one, itself among them

// The smallest turn from unit a to unit b; half a turn about any axis where they are opposite.
dmat3 turnBetween(const dvec3& a, const dvec3& b) {
  const dvec3 axis = glm::cross(a, b);
  const double cosine = glm::dot(a, b);
  if (cosine < -1 + 1e-9) {
    const dvec3 other = std::abs(a.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 u = glm::normalize(glm::cross(a, other));
    return 2.0 * glm::outerProduct(u, u) - dmat3(1.0);
  }
  const dmat3 k(0, axis.z, -axis.y, -axis.z, 0, axis.x, axis.y, -axis.x, 0);
  return dmat3(1.0) + k + k * k / (1 + cosine);
}

// The turn about unit `axis` that brings the first of each pair nearest to the second: Procrustes in the
// plane across it.
dmat3 twistBetween(const dvec3& axis, std::span<const std::pair<dvec3, dvec3>> pairs) {
  double sine = 0, cosine = 0;
  for (const auto& [from, to] : pairs) {
    sine += glm::dot(axis, glm::cross(from, to));
    cosine += glm::dot(from, to) - glm::dot(axis, from) * glm::dot(axis, to);
  }
  return glm::mat3_cast(glm::angleAxis(std::atan2(sine, cosine), axis));
}

// How the skin around each true point turned.
std::vector<dmat3> turnsOf(const TrueSkin& first, const TrueSkin& now) {
  const KdTree tree(first.position_m);
  std::vector<dmat3> turns(first.position_m.size());
  parallelFor(turns.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const dvec3 normal(now.normal[p]);
      const dmat3 tilt = turnBetween(dvec3(first.normal[p]), normal);
      std::vector<std::pair<dvec3, dvec3>> pairs;
      for (const Neighbor& k : tree.nearest(first.position_m[p], kPatch)) {
        const dvec3 from = dvec3(first.position_m[k.index]) - dvec3(first.position_m[p]);
        pairs.emplace_back(tilt * from, dvec3(now.position_m[k.index]) - dvec3(now.position_m[p]));
      }
      turns[p] = twistBetween(normal, pairs) * tilt;
    }
  });
  return turns;
}

// Where the view shows the point, by its pixel; nothing when it does not.
std::optional<dvec2> seenAt(const GBuffer& g, const Camera& camera, const vec3& position, const vec3& normal,
                            double most_m) {
  const dvec3 in_camera = camera.camera_from_world * dvec3(position);
  if (glm::dot(camera.camera_from_world.rotation * dvec3(normal), in_camera) >= 0 || in_camera.z <= 0)
    return std::nullopt;
  const dvec2 p = project(camera.intrinsics, in_camera);
  if (p.x < 0 || p.y < 0 || p.x >= camera.width || p.y >= camera.height) return std::nullopt;
  const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
  if (g.alpha(x, y) < kOpaque || std::abs(g.depth_m(x, y) - in_camera.z) > most_m) return std::nullopt;
  return p;
}

// The four pixels around a position and what each counts for.
struct Footprint {
  std::array<std::size_t, 4> pixel = {};
  std::array<float, 4> weight = {};

  Footprint(const Camera& camera, const dvec2& p) {
    const dvec2 corner = glm::floor(p - 0.5), part = p - 0.5 - corner;
    for (int k = 0; k < 4; ++k) {
      const int x = std::clamp(static_cast<int>(corner.x) + k % 2, 0, camera.width - 1);
      const int y = std::clamp(static_cast<int>(corner.y) + k / 2, 0, camera.height - 1);
      const double across = k % 2 ? part.x : 1 - part.x, down = k / 2 ? part.y : 1 - part.y;
      pixel[static_cast<std::size_t>(k)] = static_cast<std::size_t>(y) * camera.width + x;
      weight[static_cast<std::size_t>(k)] = static_cast<float>(across * down);
    }
  }
  template <class T>
  T of(const Image<T>& image) const {
    T sum{};
    for (std::size_t k = 0; k < 4; ++k) sum += weight[k] * image.pixels[pixel[k]];
    return sum;
  }
};

double meanChange(const vec3& a, const vec3& b) {
  const vec3 d = glm::abs(a - b);
  return (static_cast<double>(d.x) + d.y + d.z) / 3;
}

double changeOfDegree0(const ShBlock& before, const ShBlock& now, const std::vector<float>& opacity) {
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < opacity.size(); ++i) {
    double change = 0;
    for (int c = 0; c < 3; ++c)
      change += kShC0 * std::abs(static_cast<double>(now.of(i)[c]) - before.of(i)[c]) / 3;
    sum += opacity[i] * change;
    weight += opacity[i];
  }
  return weight > 0 ? sum / weight : 0;
}

}  // namespace

Spread spreadOf(std::vector<double> values) {
  const double middle = nearestRank(values, 0.5);
  return {middle, nearestRank(std::move(values), 0.95)};
}

std::vector<std::uint32_t> nearestPoints(const GaussianCloud& first, const TrueSkin& truth, double most_m) {
  const KdTree tree(truth.position_m);
  std::vector<std::uint32_t> nearest(first.size(), kNoPoint);
  parallelFor(first.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::vector<Neighbor> found = tree.nearest(first.position_m[i], 1);
      if (!found.empty() && found[0].squared_distance <= most_m * most_m) nearest[i] = found[0].index;
    }
  });
  return nearest;
}

Spread drift_mm(const GaussianCloud& first, const GaussianCloud& now, const TrueSkin& first_truth,
                const TrueSkin& truth, std::span<const std::uint32_t> nearest) {
  const std::vector<dmat3> turns = turnsOf(first_truth, truth);
  std::vector<double> distances;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const std::uint32_t p = nearest[i];
    if (p == kNoPoint) continue;
    const dvec3 offset = dvec3(first.position_m[i]) - dvec3(first_truth.position_m[p]);
    const dvec3 expected = dvec3(truth.position_m[p]) + turns[p] * offset;
    distances.push_back(1000 * glm::length(dvec3(now.position_m[i]) - expected));
  }
  return spreadOf(std::move(distances));
}

bool isTracked(const GaussianCloud& before, const GaussianCloud& now) {
  if (before.size() != now.size() || before.size() == 0) return false;
  dvec3 center(0);
  for (const vec3& p : before.position_m) center += dvec3(p) / static_cast<double>(before.size());
  double square = 0;
  std::vector<double> ways;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const dvec3 d = dvec3(before.position_m[i]) - center;
    square += glm::dot(d, d) / static_cast<double>(before.size());
    ways.push_back(glm::length(dvec3(now.position_m[i]) - dvec3(before.position_m[i])));
  }
  return spreadOf(std::move(ways)).median < kTrackedShare * std::sqrt(square);
}

double radianceFlicker(const GaussianCloud& before, const GaussianCloud& now) {
  return changeOfDegree0(before.color, now.color, before.opacity);
}

double baseColorFlicker(const GaussianCloud& before, const Materials& before_materials,
                        const Materials& now_materials) {
  return changeOfDegree0(before_materials.base_color, now_materials.base_color, before.opacity);
}

SeenPoints seenPoints(const GBuffer& view, const Camera& camera, const TrueSkin& truth, double most_m) {
  const std::size_t n = truth.position_m.size();
  SeenPoints s{std::vector<std::uint8_t>(n), std::vector<vec3>(n),
               std::vector<vec3>(view.base_color.empty() ? 0 : n)};
  for (std::size_t i = 0; i < n; ++i) {
    const auto at = seenAt(view, camera, truth.position_m[i], truth.normal[i], most_m);
    if (!at) continue;
    const Footprint around(camera, *at);
    const float alpha = around.of(view.alpha);
    s.seen[i] = 1;
    s.radiance[i] = around.of(view.radiance) / alpha;
    if (!s.base_color.empty()) s.base_color[i] = around.of(view.base_color) / alpha;
  }
  return s;
}

std::optional<ViewFlicker> viewFlicker(const SeenPoints& before, const SeenPoints& now) {
  ViewFlicker f;
  const bool materials = !before.base_color.empty() && !now.base_color.empty();
  for (std::size_t i = 0; i < now.seen.size(); ++i) {
    if (!before.seen[i] || !now.seen[i]) continue;
    f.radiance += meanChange(before.radiance[i], now.radiance[i]);
    if (materials) f.base_color += meanChange(before.base_color[i], now.base_color[i]);
    ++f.points;
  }
  if (f.points < kFewestPoints) return std::nullopt;
  f.radiance /= static_cast<double>(f.points);
  f.base_color /= static_cast<double>(f.points);
  return f;
}

}  // namespace beam
