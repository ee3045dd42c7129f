// SPDX-License-Identifier: Apache-2.0
// Triangle mesh of a frame, fused from the depth that the training views render (methods 2.8).
#pragma once

#include <span>

#include "core/base/fields.h"
#include "core/base/progress.h"
#include "core/render/device.h"
#include "core/scene/camera.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/mesh.h"

namespace beam {

struct ExtractMeshOptions {
  double voxel_m = 0.003;        // methods 2.8: 2 to 3 mm for a person
  double truncation_voxels = 4;  // of the signed distance
};
void describe(Fields& fields, ExtractMeshOptions& options);

Mesh extractMesh(const GaussianCloud& cloud, std::span<const Camera> cameras,
                 const ExtractMeshOptions& options, ComputeDevice& device, Progress& progress);

}  // namespace beam
