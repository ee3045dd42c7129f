// SPDX-License-Identifier: Apache-2.0
#include "core/scene/visual_hull.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/statistics.h"
#include "core/scene/rig_focus.h"

namespace beam {
namespace {

constexpr double kNearest_m = 0.01;
constexpr int kMostHalvings = 9;  // 512 cells a side

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

// A person has some hundred thousand cells on the surface; the memory of a level goes with their number.
void requireFew(std::size_t cells, double half, float cell_m) {
  constexpr std::size_t kMost = 4'000'000;
  if (cells <= kMost) return;
  throw Error(
      Error::Kind::Data,
      fmt::format("the visual hull of the masks: expected a surface of at most {} cells of {} m, found "
                  "more already at {:.3g} m; the capture is in another unit than the metre: name it "
                  "with --unit (m, cm, mm or metres a unit)",
                  kMost, cell_m, 2 * half));
}

}  // namespace

VisualHull::VisualHull(std::span<const FrameView> views) {
  for (const FrameView& v : views) {
    requirePinhole(v.camera, "visual hull");
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
    if (t.z <= kNearest_m) continue;
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

std::optional<VisualHull::PixelBox> VisualHull::boxOf(const MaskView& v, const dvec3& in_camera,
                                                      double radius) {
  const dvec2 p = project(v.intrinsics, in_camera);
  const double r = radius * std::max(v.intrinsics.fx, v.intrinsics.fy) / (in_camera.z - radius);
  if (p.x + r < 0 || p.y + r < 0 || p.x - r >= v.width || p.y - r >= v.height) return std::nullopt;
  return PixelBox{std::clamp(static_cast<int>(std::floor(p.x - r)), 0, v.width),
                  std::clamp(static_cast<int>(std::floor(p.y - r)), 0, v.height),
                  std::clamp(static_cast<int>(std::ceil(p.x + r)), 0, v.width),
                  std::clamp(static_cast<int>(std::ceil(p.y + r)), 0, v.height)};
}

std::uint32_t VisualHull::insideCount(const MaskView& v, const PixelBox& box) {
  const auto at = [&](int x, int y) { return v.integral[static_cast<std::size_t>(y) * (v.width + 1) + x]; };
  return at(box.x1, box.y1) - at(box.x0, box.y1) - at(box.x1, box.y0) + at(box.x0, box.y0);
}

std::optional<VisualHull::PixelBox> VisualHull::footprint(int view, const dvec3& center, double half) const {
  const MaskView& v = views_[static_cast<std::size_t>(view)];
  const dvec3 t = v.rotation * center + v.translation;
  const double radius = half * std::sqrt(3.0);
  if (t.z <= radius + kNearest_m) return std::nullopt;
  return boxOf(v, t, radius);
}

std::uint32_t VisualHull::insideCount(int view, const PixelBox& box) const {
  return insideCount(views_[static_cast<std::size_t>(view)], box);
}

double VisualHull::depth(int view, const dvec3& x_in_world) const {
  const MaskView& v = views_[static_cast<std::size_t>(view)];
  return (v.rotation * x_in_world + v.translation).z;
}

bool VisualHull::pictures(const MaskView& v, const dvec3& x_in_world) {
  const dvec3 t = v.rotation * x_in_world + v.translation;
  if (t.z <= kNearest_m) return false;
  const dvec2 p = project(v.intrinsics, t);
  return p.x >= 0 && p.y >= 0 && p.x < v.width && p.y < v.height;
}

bool VisualHull::leavesOtherPictures(int view, const dvec2& pixel, double nearest, double farthest,
                                     double step) const {
  const MaskView& own = views_[static_cast<std::size_t>(view)];
  const dmat3 world_from_camera = glm::transpose(own.rotation);
  const dvec3 ray = rayOf(own.intrinsics, pixel);
  for (double z = nearest; z <= farthest; z += step) {
    const dvec3 x = world_from_camera * (z * ray - own.translation);
    const bool seen = std::any_of(views_.begin(), views_.end(),
                                  [&](const MaskView& v) { return &v != &own && pictures(v, x); });
    if (!seen) return true;
  }
  return false;
}

std::optional<VisualHull::Cell> VisualHull::votedCell(const dvec3& center, double half,
                                                      int most_denials) const {
  Cell cell{center};
  for (int v = 0; v < static_cast<int>(views_.size()); ++v) {
    const std::optional<PixelBox> box = footprint(v, center, half);
    if (!box) continue;
    ++cell.seen;
    if (insideCount(v, *box) > 0) continue;
    if (cell.denials == most_denials) return std::nullopt;
    cell.deniers[static_cast<std::size_t>(cell.denials++)] = static_cast<std::int16_t>(v);
  }
  if (cell.seen < 2) return std::nullopt;
  return cell;
}

// How often a cell of `half` is to be halved for `share` of the subject's size.
int VisualHull::halvings(const dvec3& center, double half, double share) const {
  std::vector<double> ratios;
  for (const MaskView& v : views_) {
    const double z = (v.rotation * center + v.translation).z;
    const double area = v.integral.back();
    if (z <= kNearest_m || area == 0) continue;
    const double radius_px = half * std::sqrt(3.0) * std::max(v.intrinsics.fx, v.intrinsics.fy) / z;
    ratios.push_back(radius_px / std::max(1.0, share * std::sqrt(area)));
  }
  if (ratios.empty()) return 0;
  return std::clamp(static_cast<int>(std::ceil(std::log2(median(std::move(ratios))))), 0, kMostHalvings);
}

VisualHull::Cells VisualHull::cellsDeniedBy(int most_denials, double share, const Progress& progress) const {
  Cells found;
  if (views_.empty()) return found;
  const Cube cube = boundingCube();
  found.half_m = cube.half_m;
  found.cells.push_back({cube.center});
  for (int level = halvings(cube.center, found.half_m, share); level > 0; --level) {
    const double half = found.half_m /= 2;
    std::vector<std::vector<Cell>> children(found.cells.size());
    parallelFor(found.cells.size(), 256, [&](std::size_t begin, std::size_t end) {
      if (progress.stopRequested()) return;
      for (std::size_t i = begin; i < end; ++i) {
        for (int k = 0; k < 8; ++k) {
          const dvec3 step(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
          const std::optional<Cell> cell = votedCell(found.cells[i].center + half * step, half, most_denials);
          if (cell) children[i].push_back(*cell);
        }
      }
    });
    progress.check();
    found.cells.clear();
    for (const std::vector<Cell>& c : children) found.cells.insert(found.cells.end(), c.begin(), c.end());
  }
  return found;
}

VisualHull::Cover VisualHull::classify(const dvec3& center, double half) const {
  bool inside = true;
  int seen = 0;
  const double radius = half * std::sqrt(3.0);
  for (const MaskView& v : views_) {
    const dvec3 t = v.rotation * center + v.translation;
    if (t.z <= radius + kNearest_m) {
      inside = false;
      continue;
    }
    const std::optional<PixelBox> box = boxOf(v, t, radius);
    if (!box) continue;
    ++seen;
    const std::uint32_t count = insideCount(v, *box);
    if (count == 0) return Cover::Outside;
    if (count < static_cast<std::uint32_t>(box->x1 - box->x0) * static_cast<std::uint32_t>(box->y1 - box->y0))
      inside = false;
  }
  if (seen < std::min<int>(2, static_cast<int>(views_.size()))) return Cover::Outside;
  return inside ? Cover::Inside : Cover::Mixed;
}

VisualHull::Cube VisualHull::boundingCube() const {
  AxesPoint axes;
  for (const MaskView& v : views_) axes.add(v.rotation, v.translation);
  const dvec3 center = axes.point();
  double nearest = 1e9;
  for (const MaskView& v : views_) {
    const dvec3 position = -(glm::transpose(v.rotation) * v.translation);
    nearest = std::min(nearest, glm::length(position - center));
  }
  return {center, nearest * 0.75};
}

std::vector<vec3> VisualHull::surfaceCells(float cell_m, const Progress& progress) const {
  if (views_.empty()) return {};
  const Cube cube = boundingCube();
  double half = cube.half_m;
  std::vector<dvec3> cells = {cube.center};
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
    requireFew(cells.size(), half, cell_m);
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
