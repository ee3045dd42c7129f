// SPDX-License-Identifier: Apache-2.0
// What the eye meets first of a scene of Gaussians and meshes: a draw for each path, and the unlit channels
// of all of them together. Of Gaussians it is what was rasterised through the middle of a pixel; meshes and
// the ground are met at kPlaces places in it, so that their edges are smooth. Of Gaussians before and behind
// a mesh in one pixel the shares are right, and their values are blended of both.
#pragma once

#include <memory>
#include <optional>

#include "core/render/gaussian_surfaces.h"
#include "core/render/mesh_surfaces.h"
#include "core/render/pixel_rays.h"
#include "core/render/scene_renderer.h"
#include "core/render/scene_surfaces.h"

namespace beam {

// Of `rastered`, what a renderer drew of a view's Gaussians, alpha among it: the same channels with the
// meshes before and behind them. Of a mesh pixel: alpha 1 (less at an edge), rgb its base colour
// sRGB-encoded, occlusion 1, further attributes 0. Throws Cancelled.
RenderedPicture withMeshes(const RenderedPicture& rastered, const GaussianSurfaces* gaussians,
                           const MeshSurfaces& meshes, const Progress& progress);

// The channels that first hits are made of, as rows of the table say.
inline constexpr const char* kGuides[] = {kAlphaChannel, kDepthChannel, kNormalChannel, kBaseColorChannel,
                                          kRoughnessChannel};
struct Guides {
  std::shared_ptr<const Planes> alpha, depth, normal, base_color, roughness;

  explicit Guides(const RenderedPicture& picture);
  vec3 baseColor(std::size_t pixel) const;  // of the surface, where there is some alpha
};

struct FirstHit {
  PathHit hit;
  vec3 to_eye{0};
  float depth_m = 0;  // along the optical axis
};

class FirstHits {
 public:
  struct Surfaces {  // either may be missing
    const GaussianSurfaces* gaussians = nullptr;
    const MeshSurfaces* meshes = nullptr;
    const SceneSurfaces* scene = nullptr;  // of both, where there are meshes
  };
  // Keeps references.
  FirstHits(const Camera& camera, const RenderedPicture& rastered, const Surfaces& surfaces)
      : rays_(camera), rastered_(rastered), surfaces_(surfaces) {}

  // None: the ray of this path ends nowhere.
  std::optional<FirstHit> draw(int x, int y, PathNumbers& numbers) const;

 private:
  // `before_m`: the depth of a mesh that nothing behind it is seen past.
  std::optional<FirstHit> ofGaussians(int x, int y, float before_m, PathNumbers& numbers) const;
  std::optional<FirstHit> ofBoth(int x, int y, PathNumbers& numbers) const;
  PathHit seen(const GaussianSurfaces::FirstHit& first, std::size_t pixel, vec3 through,
               float before_m) const;

  PixelRays rays_;
  Guides rastered_;
  Surfaces surfaces_;
};

}  // namespace beam
