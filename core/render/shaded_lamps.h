// SPDX-License-Identifier: Apache-2.0
// The lamps of a scene with the shadows that its Gaussians cast, kept while a lamp stands where it stood.
#pragma once

#include <memory>
#include <vector>

#include "core/render/shadow_drawer.h"
#include "core/scene/lighting.h"

namespace beam {

class ComputeDevice;

struct ShadedLamp {
  LightSource source;
  std::shared_ptr<const ShadowMap> shadow;  // null: nothing keeps it off
};

class ShadedLamps {
 public:
  explicit ShadedLamps(ComputeDevice& device);

  // Those that are enabled, in their order. Valid until the next call. `scene` is the one of the call before
  // unless forget() came between.
  const std::vector<ShadedLamp>& of(const Lighting& lighting, const ResidentScene& scene);
  void forget();

 private:
  std::shared_ptr<const ShadowMap> shadowOf(const LightSource& source, const ResidentScene& scene,
                                            const std::vector<ShadedLamp>& before);

  std::unique_ptr<ShadowDrawer> drawer_;
  std::vector<ShadedLamp> lamps_;
  bool bounded_ = false;
  Sphere bounds_;  // of the scene, once it is known
};

}  // namespace beam
