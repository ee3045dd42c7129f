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

std::vector<Lamp> lampsOf(const Lighting& lighting) {
  std::vector<Lamp> lamps;
  for (const Light& light : lighting.lights) {
    if (!light.enabled) continue;
    for (const LightSource& source : sourcesOf(light)) lamps.push_back({source, castsShadows(light)});
  }
  return lamps;
}

void ShadedLamps::forEach(const std::vector<Lamp>& lamps, const ResidentScene& scene,
                          const Progress& progress, const OnLamps& on_lamps) {
  std::vector<ShadedLamp> before = std::exchange(lamps_, {});
  std::size_t bytes = 0;
  for (const auto& [source, shadows] : lamps) {
    if (source.strength == vec3(0)) continue;
    progress.check();
    ShadedLamp lamp{source, shadows ? shadowOf(source, scene, before) : nullptr};
    const std::size_t more = lamp.shadow ? lamp.shadow->bytes() : 0;
    if (!lamps_.empty() && bytes + more > kMostShadowBytes) {
      on_lamps(lamps_);
      lamps_.clear();
      before.clear();
      bytes = 0;
    }
    bytes += more;
    lamps_.push_back(std::move(lamp));
  }
  if (!lamps_.empty()) on_lamps(lamps_);
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
