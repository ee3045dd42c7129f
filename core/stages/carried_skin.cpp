// SPDX-License-Identifier: Apache-2.0
#include "core/stages/carried_skin.h"

#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/pipeline/frame_result.h"
#include "core/scene/pose.h"

namespace beam {

bool isCarried(const std::filesystem::path& skin) { return std::filesystem::exists(skin / kRestPoseFile); }

CarriedSkin readCarriedSkin(GaussianCloud cloud, const std::filesystem::path& skin,
                            const std::filesystem::path* joints) {
  if (isCarried(skin)) {
    return {std::move(cloud), readPosePly(skin / kRestPoseFile), readPosePly(skin / kJointPoseFile)};
  }
  Pose rest = poseOf(cloud);
  return {std::move(cloud), std::move(rest),
          joints ? poseOf(readSplatPly(*joints / kJointsFile).cloud) : Pose{}};
}

}  // namespace beam
