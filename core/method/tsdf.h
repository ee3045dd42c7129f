// SPDX-License-Identifier: Apache-2.0
// Truncated signed distances on sparse blocks of voxels, fused from depth pictures, and their zero surface as
// triangles.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
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

// World axes, metres; all there is where nothing else is said.
struct FusionBounds {
  dvec3 low = dvec3(-std::numeric_limits<double>::infinity());
  dvec3 high = dvec3(std::numeric_limits<double>::infinity());

  bool contains(const dvec3& x) const {
    return glm::all(glm::greaterThanEqual(x, low)) && glm::all(glm::lessThanEqual(x, high));
  }
};

struct TsdfOptions {
  float voxel_m = 0.003f;
  float truncation_m = 0.012f;
  FusionBounds bounds = {};
};

enum class MeshLimit { Voxels, Rows };

class KeptFusion;

// The blocks that a depth sample inside the bounds falls near, in the order in which they are fused; by every
// `every`th pixel a side, which tells about how many there are. Nothing: there are more than `most`.
std::optional<std::vector<std::uint64_t>> touchedBlocks(std::span<const DepthView> views,
                                                        const TsdfOptions& options, std::size_t most,
                                                        int every, const Progress& progress);

// Of `blocks`, a slab of them at a time; work is parallel over blocks, views in order: the same for any
// number of threads, taken up from `kept` or not. Nothing: more than `most_rows` vertices or triangles.
std::optional<Mesh> fuseDepth(std::span<const DepthView> views, const TsdfOptions& options,
                              std::span<const std::uint64_t> blocks, std::size_t most_rows,
                              Progress& progress, KeptFusion* kept = nullptr);

// Keeps components with at least `share` of the largest one's triangles; drops unused vertices.
Mesh keepLargeComponents(const Mesh& mesh, double share, const Progress& progress);

}  // namespace beam
