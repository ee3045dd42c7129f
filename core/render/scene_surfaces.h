// SPDX-License-Identifier: Apache-2.0
// Gaussians and meshes as the surfaces of one scene's light paths: a ray ends in the nearer of the Gaussian
// that its chance draws and what it meets of meshes and the ground. World axes, metres.
#pragma once

#include "core/render/gaussian_surfaces.h"
#include "core/render/mesh_surfaces.h"

namespace beam {

class SceneSurfaces final : public PathSurfaces {
 public:
  // Keeps references; null: there are no Gaussians. `offset_m`: of paths that leave a Gaussian
  // (PathSettings::offset_m).
  SceneSurfaces(const GaussianSurfaces* gaussians, const MeshSurfaces& meshes, float offset_m)
      : gaussians_(gaussians), meshes_(meshes), offset_m_(offset_m) {}

  std::optional<PathHit> nearest(vec3 origin_m, vec3 direction, std::uint64_t chance) const override;
  float transmittance(vec3 origin_m, vec3 direction, float distance_m) const override;

  // A hit of Gaussians, whose next ray does not begin behind a mesh that they touch. `to_eye` is unit.
  PathHit besideMeshes(PathHit hit, vec3 to_eye) const;

 private:
  const GaussianSurfaces* gaussians_;
  const MeshSurfaces& meshes_;
  float offset_m_;
};

}  // namespace beam
