// SPDX-License-Identifier: Apache-2.0
// Draws shadow maps of the Gaussians that a device holds.
#pragma once

#include "core/render/resident_scene.h"
#include "core/render/shadow_map.h"

namespace beam {

// One thread at a time. A scene of another device is an Error{Bug}.
class ShadowDrawer {
 public:
  virtual ~ShadowDrawer() = default;
  // Around all Gaussians, as far as they can cast a shadow that is seen.
  virtual Sphere boundsOf(const ResidentScene& scene) = 0;
  // Same bits for any number of threads and any instruction set.
  virtual void draw(const ResidentScene& scene, const ShadowView& view, ShadowTexels& texels) = 0;

  ShadowMap mapOf(const ResidentScene& scene, const LightSource& source, const Sphere& bounds);
};

}  // namespace beam
