// SPDX-License-Identifier: Apache-2.0
#include "core/scene/rig_focus.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/math/statistics.h"

namespace beam {

void AxesPoint::add(const dmat3& camera_from_world, const dvec3& translation) {
  const dvec3 axis(camera_from_world[0][2], camera_from_world[1][2], camera_from_world[2][2]);
  const dvec3 position = -(glm::transpose(camera_from_world) * translation);
  const dmat3 off = dmat3(1.0) - glm::outerProduct(axis, axis);
  across_ += off;
  offset_ += off * position;
  ++axes_;
}

dvec3 AxesPoint::point() const { return glm::inverse(across_ + dmat3(1e-9)) * offset_; }

bool AxesPoint::isKnown() const {
  constexpr double kLeast = 0.005;  // sin^2 of 4 degrees
  return axes_ > 1 && glm::determinant(across_ / static_cast<double>(axes_)) > kLeast;
}

std::optional<RigFocus> focusOf(std::span<const Camera> cameras) {
  AxesPoint axes;
  RigFocus focus{dvec3(0), dvec3(0), 0};
  for (const Camera& c : cameras) {
    axes.add(glm::mat3_cast(c.camera_from_world.rotation), c.camera_from_world.translation_m);
    focus.middle += centerOf(c) / static_cast<double>(cameras.size());
  }
  if (!axes.isKnown()) return std::nullopt;
  focus.point = axes.point();
  std::vector<double> distances;
  std::size_t in_front = 0;
  for (const Camera& c : cameras) {
    distances.push_back(glm::length(centerOf(c) - focus.point));
    in_front += (c.camera_from_world * focus.point).z > 0;
  }
  focus.distance_m = median(std::move(distances));
  const bool seen = 2 * in_front > cameras.size();
  if (!seen || !(focus.distance_m > 0) || !std::isfinite(focus.distance_m)) return std::nullopt;
  return focus;
}

}  // namespace beam
