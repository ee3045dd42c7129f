// SPDX-License-Identifier: Apache-2.0
#include "core/method/extract_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/hash.h"
#include "core/method/kept_fusion.h"
#include "core/method/mesh_bounds.h"
#include "core/method/tsdf.h"
#include "core/method/voxel_blocks.h"
#include "core/render/rasterizer_cache.h"
#include "core/scene/capture_placement.h"

namespace beam {
namespace {

constexpr double kSmallestComponent = 0.01;  // of the largest (methods 2.8)
constexpr float kEdge_m = 0.02f;
constexpr std::size_t kMostDebris = 2;  // times what may be kept
constexpr double kStepsToTwice = 4;     // of the voxels that are tried
constexpr float kSceneEdge = 6;         // pixels: a surface at 80 degrees
constexpr int kGlance = 4;              // pixels a side that stand for one, where blocks are only counted
constexpr double kDrawing = 0.4;        // of the time

// Weight A (n . v), 0 at depth edges, where the coverage is below one half and at grazing incidence. An edge
// is a step of kEdge_m; in a scene, which may be of any size, one of so many widths of a pixel at its depth.
DepthView depthView(const RasterImages& r, const Camera& camera, bool scene) {
  DepthView view{camera, r.median_depth, Planes(camera.width, camera.height, 1)};
  const int w = camera.width, h = camera.height;
  const std::vector<float>& z = view.depth.values;
  const float edge_of_depth = kSceneEdge / static_cast<float>(camera.intrinsics.fx);
  for (int y = 1; y < h - 1; ++y) {
    for (int x = 1; x < w - 1; ++x) {
      const int p = y * w + x;
      if (z[p] <= 0 || r.alpha.values[p] < 0.5f) continue;
      float step = 0;
      for (const int n : {p - 1, p + 1, p - w, p + w})
        step = std::max(step, z[n] > 0 ? std::abs(z[n] - z[p]) : std::numeric_limits<float>::infinity());
      if (step > (scene ? edge_of_depth * z[p] : kEdge_m)) continue;
      const vec3 n(r.normal.plane(0)[p], r.normal.plane(1)[p], r.normal.plane(2)[p]);
      const vec3 ray = glm::normalize(vec3(rayOf(camera.intrinsics, {x + 0.5, y + 0.5})));
      const float length = glm::length(n), facing = length > 0 ? -glm::dot(n, ray) / length : 0;
      view.weight.values[p] = r.alpha.values[p] * std::max(0.0f, facing);
    }
  }
  return view;
}

std::vector<DepthView> depthViews(const GaussianCloud& cloud, std::span<const Camera> cameras, bool scene,
                                  ComputeDevice& device, Progress& progress) {
  progress.expect(static_cast<std::int64_t>(cameras.size()), "cameras");
  const GaussianBuffers buffers = toBuffers(cloud);
  std::vector<DepthView> views;
  RasterizerCache rasterizers(device);
  for (const Camera& c : cameras) {
    RasterImages images;
    rasterizers.of({.width = c.width, .height = c.height, .color = false, .geometry = true})
        .forward(buffers, c, 0, vec3(0), images);
    progress.check();
    views.push_back(depthView(images, c, scene));
    progress.step();
  }
  return views;
}

// Of what has a side at all; else 1.
double sizeInPersons(const FusionBounds& bounds) {
  const dvec3 sides = bounds.high - bounds.low;
  const double longest = std::max({sides.x, sides.y, sides.z});
  return longest > 0 && std::isfinite(longest) ? longest / kPerson_m : 1;
}

// Of all that a fusion hangs on.
Digest digestOf(std::span<const DepthView> views, const ExtractMeshOptions& options, const MeshScope& scope,
                const FusionBounds& bounds) {
  Hasher hasher;
  hasher.add(fmt::format("{} {} {} {} {}", options.voxel_m, options.truncation_voxels, options.most_voxels,
                         scope.scene, scope.most_rows));
  hasher.add(std::as_bytes(std::span(&bounds, 1)));
  for (const DepthView& view : views) {
    hasher.add(std::as_bytes(std::span(view.depth.values)));
    hasher.add(std::as_bytes(std::span(view.weight.values)));
  }
  return hasher.digest();
}

// The limit, where there is more than it allows.
std::variant<Mesh, MeshLimit> meshWithin(std::span<const DepthView> views, const TsdfOptions& tsdf,
                                         std::size_t most_blocks, std::size_t most_rows, Progress& progress,
                                         KeptFusion* kept) {
  if (!touchedBlocks(views, tsdf, most_blocks, kGlance, progress)) return MeshLimit::Voxels;
  const auto blocks = touchedBlocks(views, tsdf, most_blocks, 1, progress);
  if (!blocks) return MeshLimit::Voxels;
  const std::optional<Mesh> fused = fuseDepth(views, tsdf, *blocks, kMostDebris * most_rows, progress, kept);
  if (!fused) return MeshLimit::Rows;
  Mesh mesh = keepLargeComponents(*fused, kSmallestComponent, progress);
  if (std::max(mesh.vertices.size(), mesh.triangles.size()) > most_rows) return MeshLimit::Rows;
  return mesh;
}

}  // namespace

void describe(Fields& f, ExtractMeshOptions& o) {
  f.field(
      {.name = "voxel_m",
       .label = "Voxel size",
       .help = "Size of the cells that depth is fused in, 0.002 to 0.003 m for a person; without masks in "
               "proportion to what the cameras look at, as if that were 1.75 m large.",
       .min = 0.0005,
       .max = 0.1,
       .unit = "m"},
      o.voxel_m);
  f.field({.name = "truncation_voxels",
           .label = "Truncation distance",
           .help = "How far the fused distance reaches to either side of the surface.",
           .min = 1,
           .max = 20,
           .unit = "voxels",
           .advanced = true},
          o.truncation_voxels);
  f.field(
      {.name = "most_voxels",
       .label = "Most voxels",
       .help = "How many voxels there may be near surfaces, 262144 at least, before all are made larger; 0 "
               "is 34 million without masks and 537 million with masks.",
       .min = 0,
       .max = kMostVoxels,
       .advanced = true},
      o.most_voxels);
}

int mostVoxels(const ExtractMeshOptions& options, const MeshScope& scope) {
  if (options.most_voxels > 0) return std::max(options.most_voxels, kLeastVoxels);
  return scope.scene ? kSceneVoxels : kMostVoxels;
}

ExtractedMesh extractMesh(const GaussianCloud& cloud, std::span<const Camera> cameras,
                          const ExtractMeshOptions& options, const MeshScope& scope, ComputeDevice& device,
                          Progress& progress, Checkpoint* checkpoint) {
  const std::vector<DepthView> views = [&] {
    Progress drawing = progress.part(kDrawing, "depth of the views");
    return depthViews(cloud, cameras, scope.scene, device, drawing);
  }();
  Progress fusing = progress.part(1 - kDrawing, "fusing depth");
  const FusionBounds bounds = scope.scene ? boundsFromCameras(views, fusing) : FusionBounds();
  const std::size_t most_blocks = static_cast<std::size_t>(mostVoxels(options, scope)) / kBlockVoxels;
  ExtractedMesh out;
  out.asked_m = options.voxel_m * (scope.scene ? sizeInPersons(bounds) : 1);
  std::optional<KeptFusion> kept;
  if (checkpoint) kept.emplace(*checkpoint, [&] { return digestOf(views, options, scope, bounds); });
  for (FusionTry attempt = kept ? kept->kept() : FusionTry();; ++attempt.number) {
    if (kept) kept->begin(attempt);
    out.voxel_m = out.asked_m * std::exp2(attempt.number / kStepsToTwice);
    const TsdfOptions tsdf{static_cast<float>(out.voxel_m),
                           static_cast<float>(out.voxel_m * options.truncation_voxels), bounds};
    std::variant<Mesh, MeshLimit> made =
        meshWithin(views, tsdf, most_blocks, scope.most_rows, fusing, kept ? &*kept : nullptr);
    if (Mesh* mesh = std::get_if<Mesh>(&made)) {
      out.mesh = std::move(*mesh);
      out.reached = attempt.passed;
      return out;
    }
    attempt.passed = std::get<MeshLimit>(made);
  }
}

}  // namespace beam
