// SPDX-License-Identifier: Apache-2.0
// The finished values of a frame, read back from their published files: what viewers, render and export look
// at.
#pragma once

#include <optional>

#include "core/pipeline/project.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/mesh.h"

namespace beam {

// Names of the files in results; steps write them, everybody reads them.
inline constexpr const char* kSeedsFile = "seeds.ply";
inline constexpr const char* kCloudFile = "cloud.ply";
inline constexpr const char* kMeshFile = "mesh.ply";
inline constexpr const char* kMaterialsFile = "materials.ply";
inline constexpr const char* kEnvironmentFile = "environment.exr";
inline constexpr const char* kJointsFile =
    "joints.ply";  // Gaussians, in the same order in all frames of a take
inline constexpr const char* kRestPoseFile = "rest.ply";         // of these joints, or of this skin on them
inline constexpr const char* kJointPoseFile = "joint_pose.ply";  // corrected pose that carries this skin
inline constexpr const char* kMapsFolder = "maps";               // <camera>.<map>.exr

struct FrameResult {
  GaussianCloud cloud;
  std::optional<Materials> materials;
  bool refined = false;       // geometry is final; false: appearance only
  bool interpolated = false;  // between two solved frames, without a result of its own
};

// The most finished Gaussians of the frame: with materials, else refined, else fitted; empty when there are
// none.
std::optional<FrameResult> loadFrameResult(const Project& project, FrameIndex frame);
std::optional<Mesh> loadFrameMesh(const Project& project, FrameIndex frame);

}  // namespace beam
