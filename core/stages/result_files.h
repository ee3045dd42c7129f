// SPDX-License-Identifier: Apache-2.0
// Names of the files in results; steps write them, everybody reads them.
#pragma once

namespace beam {

inline constexpr const char* kSeedsFile = "seeds.ply";
inline constexpr const char* kCloudFile = "cloud.ply";
inline constexpr const char* kMeshFile = "mesh.ply";
inline constexpr const char* kMaterialsFile = "materials.ply";
inline constexpr const char* kVisibilityFile = "visibility.ply";  // of the Gaussians of the refined cloud
inline constexpr const char* kEnvironmentFile = "environment.exr";
// Gaussians, in the same order in all frames of a take.
inline constexpr const char* kJointsFile = "joints.ply";
inline constexpr const char* kRestPoseFile = "rest.ply";         // of these joints, or of this skin on them
inline constexpr const char* kJointPoseFile = "joint_pose.ply";  // corrected pose that carries this skin
inline constexpr const char* kMapsFolder = "maps";               // <camera>.<map>.exr

}  // namespace beam
