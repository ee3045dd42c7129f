// SPDX-License-Identifier: Apache-2.0
#include "core/render/scene_surfaces.h"

namespace beam {
namespace {

constexpr float kOfRoom = 0.9f;  // between a Gaussian and the mesh before it

}  // namespace

PathHit SceneSurfaces::besideMeshes(PathHit hit, vec3 to_eye) const {
  const vec3 n = towards(to_eye, hit.normal);
  const float room_m = meshes_.distance(hit.position_m, n, offset_m_);
  if (room_m < offset_m_) hit.step_m = kOfRoom * room_m * n;
  return hit;
}

std::optional<PathHit> SceneSurfaces::nearest(vec3 o, vec3 d, std::uint64_t chance) const {
  const std::optional<PathHit> mesh = meshes_.nearest(o, d, kFar_m);
  if (!gaussians_) return mesh;
  const auto hit = gaussians_->nearest(o, d, chance, mesh ? mesh->distance_m : kFar_m);
  return hit ? besideMeshes(*hit, -d) : mesh;
}

float SceneSurfaces::transmittance(vec3 o, vec3 d, float distance_m) const {
  if (meshes_.occluded(o, d, distance_m)) return 0;
  return gaussians_ ? gaussians_->transmittance(o, d, distance_m) : 1.0f;
}

}  // namespace beam
