// SPDX-License-Identifier: Apache-2.0
#include "core/stages/carried_skin.h"

#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/scene/pose.h"
#include "core/stages/result_files.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

Pose trackedJoints(const fs::path& folder) { return poseOf(readSplatPly(folder / kJointsFile).cloud); }
Pose restSkin(const fs::path& skin) { return readPosePly(skin / kRestPoseFile); }
Pose correctedJoints(const fs::path& skin) { return readPosePly(skin / kJointPoseFile); }

}  // namespace

bool isCarried(const fs::path& skin) { return fs::exists(skin / kRestPoseFile); }

CarriedSkin readCarriedSkin(GaussianCloud cloud, const fs::path& skin, const fs::path* joints) {
  if (isCarried(skin)) return {std::move(cloud), restSkin(skin), correctedJoints(skin)};
  Pose rest = poseOf(cloud);
  return {std::move(cloud), std::move(rest), joints ? trackedJoints(*joints) : Pose{}};
}

CarriedPose readCarriedPose(const fs::path& skin, const fs::path& joints) {
  if (isCarried(skin)) return {restSkin(skin), correctedJoints(skin)};
  return {poseOf(readSplatPly(skin / kCloudFile).cloud), trackedJoints(joints)};
}

}  // namespace beam
