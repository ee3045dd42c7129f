// SPDX-License-Identifier: Apache-2.0
#include "core/scene/capture.h"

namespace beam {

std::string toText(UpAxis up) {
  switch (up) {
    case UpAxis::PlusY:
      return "+Y";
    case UpAxis::PlusZ:
      return "+Z";
    case UpAxis::MinusY:
      return "-Y";
  }
  return "+Y";
}

dmat3 worldFromCapture(UpAxis up) {
  switch (up) {
    case UpAxis::PlusY:
      return dmat3(1.0);
    // x_world = y, y_world = z, z_world = x of the capture; columns are the images of the capture's axes.
    case UpAxis::PlusZ:
      return dmat3(dvec3(0, 0, 1), dvec3(1, 0, 0), dvec3(0, 1, 0));
    case UpAxis::MinusY:
      return dmat3(dvec3(1, 0, 0), dvec3(0, -1, 0), dvec3(0, 0, -1));
  }
  return dmat3(1.0);
}

PointCloud pointCloudOf(const std::vector<dvec3>& positions, std::vector<u8vec3> color) {
  constexpr double kFar = 1e4;  // of their extent: there single precision still tells 1/1000 of it apart
  PointCloud points;
  points.color = std::move(color);
  if (positions.empty()) return points;
  dvec3 low = positions[0], high = low;
  for (const dvec3& p : positions) low = glm::min(low, p), high = glm::max(high, p);
  const dvec3 middle = 0.5 * (low + high), extent = high - low;
  if (glm::length(middle) > kFar * glm::length(extent)) points.origin = middle;
  points.position_m.reserve(positions.size());
  for (const dvec3& p : positions)
    points.position_m.emplace_back(points.origin == dvec3(0) ? p : p - points.origin);
  return points;
}

}  // namespace beam
