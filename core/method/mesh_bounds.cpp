// SPDX-License-Identifier: Apache-2.0
#include "core/method/mesh_bounds.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/parallel.h"
#include "core/math/statistics.h"
#include "core/scene/rig_focus.h"

namespace beam {
namespace {

constexpr int kSamples = 4096;       // of a view, about
constexpr double kOutermost = 0.01;  // share of the points on either side that the box leaves out
constexpr double kMargin = 0.05;     // of the box's size, on each side

struct SurfacePoint {
  dvec3 position_m;
  int seen = 0;  // by how many cameras, whether or not something stands before it
};

int camerasThatPicture(const dvec3& x, std::span<const DepthView> views) {
  return static_cast<int>(std::count_if(views.begin(), views.end(), [&](const DepthView& v) {
    const dvec3 t = v.camera.camera_from_world * x;
    if (t.z <= 0) return false;
    const dvec2 p = project(v.camera.intrinsics, t);
    return p.x >= 0 && p.y >= 0 && p.x < v.camera.width && p.y < v.camera.height;
  }));
}

std::vector<SurfacePoint> pointsOf(const DepthView& view, std::span<const DepthView> views) {
  const int w = view.depth.width, h = view.depth.height;
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(w) * h / kSamples)));
  const Rigid3 world_from_camera = inverse(view.camera.camera_from_world);
  std::vector<SurfacePoint> points;
  for (int y = step / 2; y < h; y += step) {
    for (int x = step / 2; x < w; x += step) {
      const std::size_t p = static_cast<std::size_t>(y) * w + x;
      const double depth = view.depth.values[p];
      if (depth <= 0 || view.weight.values[p] <= 0) continue;
      const dvec3 at = world_from_camera * (depth * rayOf(view.camera.intrinsics, {x + 0.5, y + 0.5}));
      points.push_back({at, camerasThatPicture(at, views)});
    }
  }
  return points;
}

std::optional<RigFocus> focusOf(std::span<const DepthView> views) {
  std::vector<Camera> cameras;
  for (const DepthView& v : views) cameras.push_back(v.camera);
  return beam::focusOf(cameras);
}

}  // namespace

FusionBounds boundsFromCameras(std::span<const DepthView> views, const Progress& progress) {
  std::vector<std::vector<SurfacePoint>> of_view(views.size());
  parallelFor(views.size(), 1, [&](std::size_t v, std::size_t) {
    if (!progress.stopRequested()) of_view[v] = pointsOf(views[v], views);
  });
  progress.check();
  std::vector<SurfacePoint> points;
  const std::optional<RigFocus> focus = focusOf(views);
  for (const std::vector<SurfacePoint>& some : of_view) {
    for (const SurfacePoint& p : some) {
      if (!focus || glm::distance(p.position_m, focus->point) < focus->distance_m) points.push_back(p);
    }
  }
  int best = 0;
  for (const SurfacePoint& p : points) best = std::max(best, p.seen);
  std::erase_if(points, [&](const SurfacePoint& p) { return 2 * p.seen < best; });
  if (points.empty()) return {};
  FusionBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> along(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) along[i] = points[i].position_m[axis];
    const double low = quantile(along, kOutermost), high = quantile(std::move(along), 1 - kOutermost);
    bounds.low[axis] = low - kMargin * (high - low);
    bounds.high[axis] = high + kMargin * (high - low);
  }
  return bounds;
}

}  // namespace beam
