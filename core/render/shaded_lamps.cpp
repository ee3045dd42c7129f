// SPDX-License-Identifier: Apache-2.0
#include "core/render/shaded_lamps.h"

#include <algorithm>
#include <utility>

#include "core/render/device.h"

namespace beam {

ShadedLamps::ShadedLamps(ComputeDevice& device) : drawer_(device.newShadowDrawer()) {}

void ShadedLamps::forget() {
  lamps_.clear();
  bounded_ = false;
}

void ShadedLamps::forEach(const Lighting& lighting, const ResidentScene& scene, const Progress& progress,
                          const OnLamps& on_lamps) {
  const std::vector<ShadedLamp> before = std::exchange(lamps_, {});
  std::size_t bytes = 0;
  const auto give = [&] {
    if (!lamps_.empty()) on_lamps(lamps_);
  };
  for (const Light& light : lighting.lights) {
    if (!light.enabled) continue;
    for (const LightSource& source : sourcesOf(light)) {
      if (source.strength == vec3(0)) continue;
      progress.check();
      lamps_.push_back({source, castsShadows(light) ? shadowOf(source, scene, before) : nullptr});
      if (lamps_.back().shadow) bytes += lamps_.back().shadow->bytes();
      if (bytes < kMostShadowBytes) continue;
      give();
      lamps_.clear();
      bytes = 0;
    }
  }
  give();
}

std::shared_ptr<const ShadowMap> ShadedLamps::shadowOf(const LightSource& source, const ResidentScene& scene,
                                                       const std::vector<ShadedLamp>& before) {
  const auto kept = std::find_if(before.begin(), before.end(), [&](const ShadedLamp& lamp) {
    return lamp.shadow && lamp.source.standsWith(source);
  });
  if (kept != before.end()) return kept->shadow;
  if (!bounded_) bounds_ = drawer_->boundsOf(scene);
  bounded_ = true;
  return std::make_shared<const ShadowMap>(drawer_->mapOf(scene, source, bounds_));
}

}  // namespace beam
