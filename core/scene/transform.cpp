// SPDX-License-Identifier: Apache-2.0
#include "core/scene/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/math/sh_rotation.h"

namespace beam {
namespace {

void requireSimilarity(const Similarity3& s) {
  const dmat3& r = s.rotation;
  const dmat3 square = glm::transpose(r) * r;
  double off = std::abs(glm::determinant(r) - 1);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) off = std::max(off, std::abs(square[i][j] - (i == j)));
  }
  if (!(off < 1e-6))
    throw Error(Error::Kind::Bug, "Gaussians can be turned by a rotation only; a mirror has no quaternion");
  if (!(s.scale > 0) || !std::isfinite(s.scale))
    throw Error(Error::Kind::Bug, "a similarity needs a positive scale");
}

void turn(std::vector<float>& coefficients, int channels, const dmat3& rotation) {
  const ShRotation rotate(rotation);
  const std::size_t each = static_cast<std::size_t>(kShCount) * channels;
  std::vector<float> before(each);
  for (std::size_t i = 0; i + each <= coefficients.size(); i += each) {
    std::copy_n(coefficients.begin() + static_cast<std::ptrdiff_t>(i), each, before.begin());
    rotate.apply(channels, before.data(), coefficients.data() + i);
  }
}

}  // namespace

GaussianCloud transformed(const GaussianCloud& cloud, const Similarity3& a_from_b) {
  requireSimilarity(a_from_b);
  GaussianCloud out = cloud;
  const quat q = quat(glm::quat_cast(a_from_b.rotation));
  for (vec3& p : out.position_m) p = vec3(a_from_b * dvec3(p));
  for (quat& r : out.rotation) r = glm::normalize(q * r);
  if (a_from_b.scale != 1) {
    for (vec3& s : out.scale_m) s = vec3(a_from_b.scale * dvec3(s));
  }
  turn(out.color.coefficients, out.color.channels, a_from_b.rotation);
  return out;
}

Materials transformed(const Materials& materials, const Similarity3& a_from_b) {
  requireSimilarity(a_from_b);
  Materials out = materials;
  turn(out.base_color.coefficients, out.base_color.channels, a_from_b.rotation);
  turn(out.ambient_occlusion.coefficients, out.ambient_occlusion.channels, a_from_b.rotation);
  return out;
}

Attribute transformed(const Attribute& attribute, const Similarity3& a_from_b) {
  requireSimilarity(a_from_b);
  Attribute out = attribute;
  if (out.info.turns()) turn(out.values, out.info.channels, a_from_b.rotation);
  return out;
}

Mesh transformed(const Mesh& mesh, const Similarity3& a_from_b) {
  requireSimilarity(a_from_b);
  Mesh out = mesh;
  for (vec3& v : out.vertices) v = vec3(a_from_b * dvec3(v));
  for (vec3& n : out.normals) n = vec3(a_from_b.rotation * dvec3(n));
  return out;
}

Camera transformed(const Camera& camera, const Similarity3& a_from_b) {
  requireSimilarity(a_from_b);
  Camera out = camera;
  Rigid3& pose = out.camera_from_world;
  const dquat b_from_a = glm::conjugate(glm::normalize(glm::quat_cast(a_from_b.rotation)));
  pose.rotation = glm::normalize(pose.rotation * b_from_a);
  if (!isTurn(a_from_b))
    pose.translation_m = a_from_b.scale * pose.translation_m - pose.rotation * a_from_b.translation;
  return out;
}

PointCloud transformed(const PointCloud& points, const Similarity3& a_from_b) {
  requireSimilarity(a_from_b);
  std::vector<dvec3> positions(points.position_m.size());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = a_from_b * points.position(i);
  return pointCloudOf(positions, points.color);
}

std::string lengthUnit(const Similarity3& a_from_world) {
  const double metres = 1 / a_from_world.scale;
  return metres == 1 ? "m" : fmt::format("{} m", metres);
}

std::string roundingWarning(const Similarity3& capture_from_world) {
  constexpr double kLost_m = 1e-4;  // less than a photograph shows of a person
  const dvec3 far = glm::abs(capture_from_world.translation);
  const auto distance = static_cast<float>(std::max({far.x, far.y, far.z}));
  const float next = std::nextafter(distance, std::numeric_limits<float>::max());
  const double step_m = (static_cast<double>(next) - distance) / capture_from_world.scale;
  if (!(step_m > kLost_m)) return {};
  return fmt::format(
      "the capture lies {:.0f} of its units from its origin: in its axes positions are rounded to "
      "{:.3g} mm; world axes keep them (--frame-of world)",
      distance, 1000 * step_m);
}

CaptureSet transformed(CaptureSet capture, const Similarity3& a_from_b) {
  for (View& view : capture.views) view.camera = transformed(view.camera, a_from_b);
  capture.seed_points = transformed(capture.seed_points, a_from_b);
  capture.capture_from_world = capture.capture_from_world * inverse(a_from_b);
  return capture;
}

}  // namespace beam
