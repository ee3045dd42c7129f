// SPDX-License-Identifier: Apache-2.0
// Gaussians as the surfaces of light paths: a ray ends in one of them, drawn by its blend weight (methods
// 7.5), and light gets past them as much as blending lets through. World axes, metres.
#pragma once

#include <memory>
#include <vector>

#include "core/render/device.h"
#include "core/render/path_integrator.h"
#include "core/scene/render_scene.h"

namespace beam {

class GaussianSurfaces final : public PathSurfaces {
 public:
  // Of all instances together. Where one has no materials nothing can be hit, which is an Error{Bug}, and
  // alphaBefore() holds.
  GaussianSurfaces(const std::vector<RenderInstance>& instances, ComputeDevice& device);

  // Its normal is -normalize(Sigma^-1 d), its base colour that of `direction` (methods 7.5).
  std::optional<PathHit> nearest(vec3 origin_m, vec3 direction, std::uint64_t chance) const override {
    return nearest(origin_m, direction, chance, kEndless_m);
  }
  std::optional<PathHit> nearest(vec3 origin_m, vec3 direction, std::uint64_t chance, float reach_m) const;
  float transmittance(vec3 origin_m, vec3 direction, float distance_m) const override;

  // Of a ray that starts outside of everything, where Gaussians seen from behind are blended as well.
  struct FirstHit {
    PathHit hit;
    bool from_behind = false;  // it faces away from the eye
  };
  std::optional<FirstHit> first(vec3 eye_m, vec3 direction, std::uint64_t chance) const;
  // How often, of all chances, first() is nearer.
  float alphaBefore(vec3 eye_m, vec3 direction, float distance_m) const;

 private:
  PathHit hitOf(const SplatHit& hit, vec3 origin, vec3 direction) const;
  BlendRules rules(float reach_m = kEndless_m) const {
    return {.reach_m = reach_m, .outward = outward_.empty() ? nullptr : outward_.data()};
  }

  GaussianCloud cloud_;
  Materials materials_;        // of all, or none
  std::vector<vec3> outward_;  // empty: not of every instance known
  std::unique_ptr<Tracer> tracer_;
};

}  // namespace beam
