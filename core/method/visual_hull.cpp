// SPDX-License-Identifier: Apache-2.0
#include "core/method/visual_hull.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace beam {
namespace {

constexpr std::uint8_t kInside = 128;

std::vector<std::uint32_t> integralOf(const Image<std::uint8_t>& mask) {
  const int w = mask.width + 1;
  std::vector<std::uint32_t> sums(static_cast<std::size_t>(w) * (mask.height + 1), 0);
  for (int y = 0; y < mask.height; ++y) {
    std::uint32_t row = 0;
    for (int x = 0; x < mask.width; ++x) {
      row += mask(x, y) >= kInside;
      sums[static_cast<std::size_t>(y + 1) * w + x + 1] = sums[static_cast<std::size_t>(y) * w + x + 1] + row;
    }
  }
  return sums;
}

}  // namespace

VisualHull::VisualHull(std::span<const FrameView> views) {
  for (const FrameView& v : views) {
    if (v.mask.empty()) continue;
    const Rigid3& pose = v.camera.camera_from_world;
    views_.push_back({glm::mat3_cast(pose.rotation), pose.translation_m, v.camera.intrinsics, v.mask.width,
                      v.mask.height, &v.mask, integralOf(v.mask)});
  }
}

VisualHull::Votes VisualHull::votes(vec3 x_in_world) const {
  Votes votes;
  for (const MaskView& v : views_) {
    const dvec3 t = v.rotation * dvec3(x_in_world) + v.translation;
    if (t.z <= 0.01) continue;
    const dvec2 p = project(v.intrinsics, t);
    if (!(p.x >= 0 && p.y >= 0 && p.x < v.width && p.y < v.height)) continue;
    ++votes.seen;
    votes.inside += (*v.mask)(static_cast<int>(p.x), static_cast<int>(p.y)) >= kInside;
  }
  return votes;
}

bool VisualHull::contains(vec3 x_in_world) const {
  const Votes v = votes(x_in_world);
  return v.seen >= std::min<int>(2, static_cast<int>(views_.size())) && v.inside == v.seen;
}

VisualHull::Cover VisualHull::classify(const dvec3& center, double half) const {
  bool inside = true;
  int seen = 0;
  const double radius = half * std::sqrt(3.0);
  for (const MaskView& v : views_) {
    const dvec3 t = v.rotation * center + v.translation;
    if (t.z <= radius + 0.01) {
      inside = false;
      continue;
    }
    const dvec2 p = project(v.intrinsics, t);
    const double r = radius * std::max(v.intrinsics.fx, v.intrinsics.fy) / (t.z - radius);
    if (p.x + r < 0 || p.y + r < 0 || p.x - r >= v.width || p.y - r >= v.height) continue;
    const int x0 = std::clamp(static_cast<int>(std::floor(p.x - r)), 0, v.width);
    const int x1 = std::clamp(static_cast<int>(std::ceil(p.x + r)), 0, v.width);
    const int y0 = std::clamp(static_cast<int>(std::floor(p.y - r)), 0, v.height);
    const int y1 = std::clamp(static_cast<int>(std::ceil(p.y + r)), 0, v.height);
    ++seen;
    const auto at = [&](int x, int y) { return v.integral[static_cast<std::size_t>(y) * (v.width + 1) + x]; };
    const std::uint32_t count = at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0);
    if (count == 0) return Cover::Outside;
    if (count < static_cast<std::uint32_t>(x1 - x0) * static_cast<std::uint32_t>(y1 - y0)) inside = false;
  }
  if (seen < std::min<int>(2, static_cast<int>(views_.size()))) return Cover::Outside;
  return inside ? Cover::Inside : Cover::Mixed;
}

// The point nearest to all optical axes, and a cube around it that reaches half way to the nearest camera's
// distance.
void VisualHull::boundingCube(dvec3& center, double& half) const {
  dmat3 a(0.0);
  dvec3 b(0.0);
  std::vector<dvec3> positions;
  for (const MaskView& v : views_) {
    const dvec3 axis(v.rotation[0][2], v.rotation[1][2], v.rotation[2][2]);
    const dvec3 position = -(glm::transpose(v.rotation) * v.translation);
    const dmat3 off = dmat3(1.0) - glm::outerProduct(axis, axis);
    a += off;
    b += off * position;
    positions.push_back(position);
  }
  a += dmat3(1e-9);
  center = glm::inverse(a) * b;
  double nearest = 1e9;
  for (const dvec3& p : positions) nearest = std::min(nearest, glm::length(p - center));
  half = nearest * 0.75;
}

std::vector<vec3> VisualHull::surfaceCells(float cell_m, const Progress& progress) const {
  if (views_.empty()) return {};
  dvec3 origin;
  double half = 0;
  boundingCube(origin, half);
  std::vector<dvec3> cells = {origin};
  while (half > cell_m / 2 && !cells.empty()) {
    half /= 2;
    std::vector<std::vector<dvec3>> children(cells.size());
    parallelFor(cells.size(), 256, [&](std::size_t begin, std::size_t end) {
      if (progress.stopRequested()) return;
      for (std::size_t i = begin; i < end; ++i) {
        for (int k = 0; k < 8; ++k) {
          const dvec3 c = cells[i] + half * dvec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
          if (classify(c, half) == Cover::Mixed) children[i].push_back(c);
        }
      }
    });
    std::vector<dvec3> next;
    for (const std::vector<dvec3>& c : children) next.insert(next.end(), c.begin(), c.end());
    cells = std::move(next);
    progress.check();
  }
  // Of the mixed leaves the surface passes through those whose corners disagree.
  std::vector<std::uint8_t> crossed(cells.size(), 0);
  parallelFor(cells.size(), 1024, [&](std::size_t begin, std::size_t end) {
    if (progress.stopRequested()) return;
    for (std::size_t i = begin; i < end; ++i) {
      int inside = 0;
      for (int k = 0; k < 8; ++k) {
        inside += contains(vec3(cells[i] + half * dvec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
      }
      crossed[i] = inside > 0 && inside < 8;
    }
  });
  progress.check();
  std::vector<vec3> surface;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (crossed[i]) surface.emplace_back(cells[i]);
  }
  return surface;
}

}  // namespace beam
