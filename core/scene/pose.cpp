// SPDX-License-Identifier: Apache-2.0
#include "core/scene/pose.h"

namespace beam {

Pose poseOf(const GaussianCloud& cloud) { return {cloud.position_m, cloud.rotation}; }

void setPose(GaussianCloud& cloud, const Pose& pose) {
  cloud.position_m = pose.position_m;
  cloud.rotation = pose.rotation;
  for (quat& q : cloud.rotation) q = glm::normalize(q);
}

}  // namespace beam
