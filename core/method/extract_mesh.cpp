// SPDX-License-Identifier: Apache-2.0
#include "core/method/extract_mesh.h"

#include <algorithm>
#include <cmath>

#include "core/method/tsdf.h"
#include "core/render/rasterizer_cache.h"

namespace beam {
namespace {

constexpr double kSmallestComponent = 0.01;  // of the largest (methods 2.8)
constexpr float kEdge_m = 0.02f;

// Weight A (n . v), 0 at depth edges, where the coverage is below one half and at grazing incidence.
DepthView depthView(const RasterImages& r, const Camera& camera) {
  DepthView view{camera, r.median_depth, Planes(camera.width, camera.height, 1)};
  const int w = camera.width, h = camera.height;
  const std::vector<float>& z = view.depth.values;
  for (int y = 1; y < h - 1; ++y) {
    for (int x = 1; x < w - 1; ++x) {
      const int p = y * w + x;
      if (z[p] <= 0 || r.alpha.values[p] < 0.5f) continue;
      float step = 0;
      for (const int n : {p - 1, p + 1, p - w, p + w})
        step = std::max(step, z[n] > 0 ? std::abs(z[n] - z[p]) : 1.0f);
      if (step > kEdge_m) continue;
      const vec3 n(r.normal.plane(0)[p], r.normal.plane(1)[p], r.normal.plane(2)[p]);
      const vec3 ray = glm::normalize(vec3(rayOf(camera.intrinsics, {x + 0.5, y + 0.5})));
      const float length = glm::length(n), facing = length > 0 ? -glm::dot(n, ray) / length : 0;
      view.weight.values[p] = r.alpha.values[p] * std::max(0.0f, facing);
    }
  }
  return view;
}

}  // namespace

void describe(Fields& f, ExtractMeshOptions& o) {
  f.field({.name = "voxel_m",
           .label = "Voxel size",
           .help = "Size of the cells that depth is fused in; 0.002 to 0.003 m for a person.",
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
}

Mesh extractMesh(const GaussianCloud& cloud, std::span<const Camera> cameras,
                 const ExtractMeshOptions& options, ComputeDevice& device, Progress& progress) {
  Progress depth = progress.part(0.5, "depth of the views");
  depth.expect(static_cast<std::int64_t>(cameras.size()), "cameras");
  const GaussianBuffers buffers = toBuffers(cloud);
  std::vector<DepthView> views;
  RasterizerCache rasterizers(device);
  for (const Camera& c : cameras) {
    RasterImages images;
    rasterizers.of({.width = c.width, .height = c.height, .color = false, .geometry = true})
        .forward(buffers, c, 0, vec3(0), images);
    views.push_back(depthView(images, c));
    depth.step();
  }
  const TsdfOptions tsdf{static_cast<float>(options.voxel_m),
                         static_cast<float>(options.voxel_m * options.truncation_voxels)};
  Progress fusing = progress.part(0.5, "fusing depth");
  return keepLargeComponents(fuseDepth(views, tsdf, fusing), kSmallestComponent);
}

}  // namespace beam
