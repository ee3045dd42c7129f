// SPDX-License-Identifier: Apache-2.0
// Triangle mesh of a frame, fused from the depth that the training views render (methods 2.8).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "core/base/checkpoint.h"
#include "core/base/fields.h"
#include "core/base/progress.h"
#include "core/method/tsdf.h"
#include "core/render/device.h"
#include "core/scene/camera.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/mesh.h"

namespace beam {

struct ExtractMeshOptions {
  double voxel_m = 0.003;        // methods 2.8: 2 to 3 mm for a person; for a scene as if it were as large
  double truncation_voxels = 4;  // of the signed distance
  int most_voxels = 0;           // near surfaces; 0: kSceneVoxels for a scene, kMostVoxels for a subject
};
void describe(Fields& fields, ExtractMeshOptions& options);

// A person in voxels of 0.5 mm, the finest, has fewer than kMostVoxels.
inline constexpr int kLeastVoxels = 1 << 18, kSceneVoxels = 1 << 25, kMostVoxels = 1 << 29;

struct MeshScope {
  // No mask cuts the subject out or tells its size: the cloud holds what is around it, too, and the mesh is
  // of what the cameras look at.
  bool scene = false;
  std::size_t most_rows = std::numeric_limits<std::uint32_t>::max();  // vertices, or triangles
};

struct ExtractedMesh {
  Mesh mesh;
  double asked_m = 0;                // the options' voxels; of a scene in proportion to its size
  double voxel_m = 0;                // those, or coarser
  std::optional<MeshLimit> reached;  // that made them coarser
};

// With `checkpoint` it goes on from the slabs that were kept there, and keeps those that are fused.
ExtractedMesh extractMesh(const GaussianCloud& cloud, std::span<const Camera> cameras,
                          const ExtractMeshOptions& options, const MeshScope& scope, ComputeDevice& device,
                          Progress& progress, Checkpoint* checkpoint = nullptr);

// The limit that `options` set, in voxels.
int mostVoxels(const ExtractMeshOptions& options, const MeshScope& scope);

}  // namespace beam
