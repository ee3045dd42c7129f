// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/frame_result.h"

#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"

namespace beam {

std::optional<FrameResult> loadFrameResult(const Project& project, FrameIndex frame) {
  if (const auto folder = project.result("materials.fit", frame)) {
    SplatFile file = readSplatPly(*folder / kMaterialsFile);
    return FrameResult{std::move(file.cloud), std::move(file.materials), true};
  }
  for (const char* step : {"surface.refine", "surface.fit"}) {
    const auto folder = project.result(step, frame);
    if (!folder) continue;
    return FrameResult{readSplatPly(*folder / kCloudFile).cloud, std::nullopt,
                       step == std::string_view("surface.refine")};
  }
  return std::nullopt;
}

std::optional<Mesh> loadFrameMesh(const Project& project, FrameIndex frame) {
  const auto folder = project.result("surface.mesh", frame);
  if (!folder) return std::nullopt;
  return readMeshPly(*folder / kMeshFile);
}

}  // namespace beam
