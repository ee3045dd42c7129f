// SPDX-License-Identifier: Apache-2.0
// The axis along which a Gaussian is thinnest: its normal, but for the side.
#pragma once

#include <vector>

#include "core/scene/gaussian_cloud.h"

namespace beam {

// Unit, world; the first of equal ones. It turns with the cloud.
inline vec3 thinAxis(const GaussianCloud& cloud, std::size_t i) {
  const vec3 s = cloud.scale_m[i];
  const int axis = s.x <= s.y && s.x <= s.z ? 0 : s.y <= s.z ? 1 : 2;
  return glm::mat3_cast(cloud.rotation[i])[axis];
}

inline std::vector<vec3> thinAxes(const GaussianCloud& cloud) {
  std::vector<vec3> axes(cloud.size());
  for (std::size_t i = 0; i < axes.size(); ++i) axes[i] = thinAxis(cloud, i);
  return axes;
}

// Away from the middle of the cloud: all that is known of a Gaussian that nobody sees. Wrong on the inner
// side of limbs.
inline vec3 outwardAxis(const GaussianCloud& cloud, std::size_t i, vec3 center) {
  const vec3 n = thinAxis(cloud, i);
  return glm::dot(n, cloud.position_m[i] - center) < 0 ? -n : n;
}
inline vec3 centerOf(const GaussianCloud& cloud) {
  vec3 center(0);
  for (const vec3& p : cloud.position_m) center += p / static_cast<float>(cloud.size());
  return center;
}

}  // namespace beam
