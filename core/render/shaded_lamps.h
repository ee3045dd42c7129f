// SPDX-License-Identifier: Apache-2.0
// The lamps of a scene with the shadows that its Gaussians cast, kept while a lamp stands where it stood.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "core/base/progress.h"
#include "core/render/shadow_drawer.h"
#include "core/scene/lighting.h"

namespace beam {

class ComputeDevice;

// Of maps at a time; as many are there of before while lamps move.
inline constexpr std::size_t kMostShadowBytes = std::size_t(256) << 20;

struct Lamp {
  LightSource source;
  bool shadows = true;
};
std::vector<Lamp> lampsOf(const Lighting& lighting);  // of its lights that are enabled

struct ShadedLamp {
  LightSource source;
  std::shared_ptr<const ShadowMap> shadow;  // null: nothing keeps it off
};

class ShadedLamps {
 public:
  explicit ShadedLamps(ComputeDevice& device);

  // Those that shine, in their order, as many at a time as their maps may take memory: usually all at once,
  // and kept then. `scene` is the one of the call before unless forget() came between.
  // Throws Cancelled when the progress is stopped.
  using OnLamps = std::function<void(const std::vector<ShadedLamp>&)>;
  void forEach(const std::vector<Lamp>& lamps, const ResidentScene& scene, const Progress& progress,
               const OnLamps& on_lamps);
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
