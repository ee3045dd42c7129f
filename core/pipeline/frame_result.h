// SPDX-License-Identifier: Apache-2.0
// The finished values of a frame, read back from their published files: what viewers, render and export look
// at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/hash.h"
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

// Steps whose results a frame can be shown from; TakeSurvey lists what is left of them.
inline constexpr const char* kMaterialsStep = "materials.fit";
inline constexpr const char* kRefineStep = "surface.refine";
inline constexpr const char* kFitStep = "surface.fit";
inline constexpr const char* kMeshStep = "surface.mesh";

// A finished result of one of these steps, with whatever settings it was made.
struct Leftover {
  std::string step;
  Digest key;
  Digest surface;  // the refined surface that it is or is made from; zero: none
  bool operator==(const Leftover&) const = default;
};
using Leftovers = std::vector<Leftover>;  // of a frame, the newest first

struct FrameResult {
  GaussianCloud cloud;
  std::optional<Materials> materials;
  bool refined = false;         // geometry is final; false: appearance only
  bool interpolated = false;    // between two solved frames, without a result of its own
  bool stale = false;           // not what the settings in force would give
  std::string stale_note = {};  // what of it is not: "materials made with other settings"
};

// The most finished Gaussians of the frame: with materials, else refined, else fitted; empty when there are
// none.
std::optional<FrameResult> loadFrameResult(const Project& project, FrameIndex frame);
std::optional<Mesh> loadFrameMesh(const Project& project, FrameIndex frame);

// --- Of settings that are no longer in force: to look at, never to score or to export. Damaged ones are
// passed over. ---
// The newest materials that stand on the surface which the settings in force give.
std::optional<FrameResult> loadOlderMaterials(const Project& project, FrameIndex frame,
                                              const Leftovers& leftovers);
// The newest with materials, else refined, else fitted.
std::optional<FrameResult> loadLeftover(const Project& project, const Leftovers& leftovers);
// The mesh of the surface that loadLeftover shows.
std::optional<Mesh> loadLeftoverMesh(const Project& project, const Leftovers& leftovers);

}  // namespace beam
