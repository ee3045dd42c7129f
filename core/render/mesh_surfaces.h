// SPDX-License-Identifier: Apache-2.0
// The meshes and the ground of a scene as surfaces that stop light wholly, seen and lit from both sides.
// World axes, metres.
#pragma once

#include <optional>
#include <vector>

#include "core/render/path_integrator.h"
#include "core/render/triangle_tracer.h"
#include "core/scene/render_scene.h"

namespace beam {

class MeshSurfaces {
 public:
  // Throws Error{Data} as TriangleTracer does, and for normals or uv that are not one a vertex or not finite.
  MeshSurfaces(const std::vector<RenderMesh>& meshes, const Ground& ground);

  // What a ray meets within `reach_m`. Its normal is that of shading, turned towards the ray: between those
  // of the corners, where the mesh has some. Textures are bilinear and go on past their edges from the other
  // side. A path goes on from just before the surface (PathHit::step_m), whatever the scene's scale.
  std::optional<PathHit> nearest(vec3 origin_m, vec3 direction, float reach_m) const;
  // To what a ray meets; `reach_m` where it meets nothing.
  float distance(vec3 origin_m, vec3 direction, float reach_m) const;
  bool occluded(vec3 origin_m, vec3 direction, float reach_m) const {
    return groundAt(origin_m, direction) < reach_m || triangles_.occluded(origin_m, direction, reach_m);
  }

 private:
  struct Finish {  // as of RenderMesh
    std::shared_ptr<const MeshTextures> textures;
    vec3 base_color;
    float roughness;
  };

  float groundAt(vec3 origin_m, vec3 direction) const;  // infinite: it is not met
  PathHit groundHit(vec3 origin_m, vec3 direction, float distance_m) const;
  PathHit meshHit(const TriangleHit& hit, vec3 direction) const;

  std::vector<Mesh> meshes_;  // in the world
  std::vector<Finish> finishes_;
  Ground ground_;
  TriangleTracer triangles_;
};

}  // namespace beam
