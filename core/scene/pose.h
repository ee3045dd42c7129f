// SPDX-License-Identifier: Apache-2.0
// Where a set of Gaussians is and how it is turned, at one moment: of joints, or of skin.
#pragma once

#include <vector>

#include "core/scene/gaussian_cloud.h"

namespace beam {

// Both arrays have size() entries.
struct Pose {
  std::vector<vec3> position_m;
  std::vector<quat> rotation;  // world_from_gaussian; read as q / |q|

  std::size_t size() const { return position_m.size(); }
};

Pose poseOf(const GaussianCloud& cloud);
void setPose(GaussianCloud& cloud, const Pose& pose);  // normalises

}  // namespace beam
