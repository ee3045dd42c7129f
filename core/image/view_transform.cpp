// SPDX-License-Identifier: Apache-2.0
#include "core/image/view_transform.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/math/color.h"

namespace beam {
namespace {

vec3 standard(vec3 linear) { return srgbFromLinear(glm::clamp(linear, 0.0f, 1.0f)); }

// Khronos PBR Neutral, of the group's specification: base colours under grey light stay what they are, bright
// light fades to white.
vec3 neutral(vec3 linear) {
  constexpr float kStart = 0.8f - 0.04f, kDesaturation = 0.15f;
  vec3 c = glm::max(linear, vec3(0));
  const float least = std::min({c.x, c.y, c.z});
  c -= least < 0.08f ? least - 6.25f * least * least : 0.04f;
  const float peak = std::max({c.x, c.y, c.z});
  if (peak < kStart) return standard(c);
  constexpr float kRest = 1 - kStart;
  const float shown = 1 - kRest * kRest / (peak + kRest - kStart);
  const float white = 1 - 1 / (kDesaturation * (peak - shown) + 1);
  return standard(glm::mix(c * (shown / peak), vec3(shown), white));
}

}  // namespace

const std::vector<std::string>& viewTransforms() {
  static const std::vector<std::string> kNames = {"standard", "neutral"};
  return kNames;
}

ViewTransform viewTransformOf(std::string_view name) {
  if (name == viewTransforms()[0]) return standard;
  if (name == viewTransforms()[1]) return neutral;
  throw Error(Error::Kind::Usage, fmt::format("the view transform \"{}\" is not drawn: expected one of {}, "
                                              "or raw, which is linear light in OpenEXR",
                                              name, fmt::join(viewTransforms(), ", ")));
}

}  // namespace beam
