// SPDX-License-Identifier: Apache-2.0
#include "core/render/shadow_drawer.h"

#include <algorithm>

namespace beam {

ShadowMap ShadowDrawer::mapOf(const ResidentScene& scene, const LightSource& source, const Sphere& bounds) {
  ShadowMap map;
  map.views = shadowViewsOf(source, bounds);
  map.texels.resize(map.views.size());
  for (std::size_t i = 0; i < map.views.size(); ++i) draw(scene, map.views[i], map.texels[i]);
  if (scene.has(kNormalSideName)) return map;
  const float texel_m = 2 * bounds.radius_m / kShadowSize;
  map.bias_m = std::max(kShadowBias_m, 2 * texel_m);
  return map;
}

}  // namespace beam
