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

const std::vector<ShadedLamp>& ShadedLamps::of(const Lighting& lighting, const ResidentScene& scene) {
  const std::vector<ShadedLamp> before = std::exchange(lamps_, {});
  for (const Light& light : lighting.lights) {
    if (!light.enabled) continue;
    for (const LightSource& source : sourcesOf(light))
      lamps_.push_back({source, castsShadows(light) ? shadowOf(source, scene, before) : nullptr});
  }
  return lamps_;
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
