// SPDX-License-Identifier: Apache-2.0
// Truncated signed distances on sparse blocks of voxels, fused from depth pictures, and their zero surface as
// triangles.
#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/scene/camera.h"
#include "core/scene/mesh.h"

namespace beam {

// One view's depth along the optical axis in metres (0: none) with a weight a pixel.
struct DepthView {
  Camera camera;
  Planes depth;   // 1
  Planes weight;  // 1
};

struct TsdfOptions {
  float voxel_m = 0.003f;
  float truncation_m = 0.012f;
};

// Blocks are those that a depth sample falls near; work is parallel over blocks, views in order: the same for
// any number of threads.
Mesh fuseDepth(std::span<const DepthView> views, const TsdfOptions& options, Progress& progress);

// Keeps components with at least `share` of the largest one's triangles; drops unused vertices.
Mesh keepLargeComponents(const Mesh& mesh, double share);

}  // namespace beam
