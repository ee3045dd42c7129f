// SPDX-License-Identifier: Apache-2.0
#include "core/render/gaussian_surfaces.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/math/brdf.h"
#include "core/scene/thin_axis.h"
#include "core/scene/transform.h"

namespace beam {
namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void append(GaussianCloud& to, const GaussianCloud& from) {
  append(to.position_m, from.position_m);
  append(to.rotation, from.rotation);
  append(to.scale_m, from.scale_m);
  append(to.opacity, from.opacity);
}

void append(Materials& to, const Materials& from) {
  append(to.roughness, from.roughness);
  append(to.base_color.coefficients, from.base_color.coefficients);
}

vec3 baseColor(const ShBlock& block, std::size_t i, vec3 direction) {
  const auto basis = shBasis(direction);
  const float* c = block.of(i);
  vec3 sum(0.5f);
  for (int k = 0; k < kShCount; ++k) sum += basis[k] * vec3(c[3 * k], c[3 * k + 1], c[3 * k + 2]);
  return glm::clamp(sum, 0.0f, 1.0f);
}

}  // namespace

GaussianSurfaces::GaussianSurfaces(const std::vector<RenderInstance>& instances, ComputeDevice& device)
    : materials_{{}, ShBlock(0, 3), ShBlock(0, 1)} {
  const bool materials =
      std::all_of(instances.begin(), instances.end(), [](const RenderInstance& i) { return !!i.materials; });
  for (const RenderInstance& i : instances) {
    append(cloud_, transformed(*i.cloud, i.world_from_cloud));
    if (materials) append(materials_, transformed(*i.materials, i.world_from_cloud));
  }
  for (const RenderInstance& i : instances) {
    const Attribute* side = attributeNamed(*i.attributes, kNormalSideName);
    if (!side) {
      outward_.clear();
      break;
    }
    for (const float s : side->values) {
      outward_.push_back(s * thinAxis(cloud_, outward_.size()));
    }
  }
  tracer_ = device.newTracer({}, cloud_);
}

PathHit GaussianSurfaces::hitOf(const SplatHit& hit, vec3 origin, vec3 direction) const {
  const std::size_t i = hit.splat;
  if (materials_.roughness.empty()) throw Error(Error::Kind::Bug, "paths among Gaussians without materials");
  const mat3 axes = glm::mat3_cast(cloud_.rotation[i]);
  const vec3 scale = glm::max(cloud_.scale_m[i], vec3(1e-6f));
  const vec3 steep = axes * ((direction * axes) / (scale * scale));
  return {.position_m = origin + hit.distance_m * direction,
          .normal = -glm::normalize(steep),
          .distance_m = hit.distance_m,
          .base_color = baseColor(materials_.base_color, i, direction),
          .roughness = std::clamp(materials_.roughness[i], kLeastRoughness, 1.0f)};
}

std::optional<PathHit> GaussianSurfaces::nearest(vec3 origin, vec3 direction, std::uint64_t chance,
                                                 float reach_m) const {
  const std::optional<SplatHit> hit = tracer_->drawn({origin, direction}, chance, rules(reach_m));
  return hit ? std::optional<PathHit>(hitOf(*hit, origin, direction)) : std::nullopt;
}

std::optional<GaussianSurfaces::FirstHit> GaussianSurfaces::first(vec3 eye, vec3 direction,
                                                                  std::uint64_t chance) const {
  const std::optional<SplatHit> hit = tracer_->drawn({eye, direction}, chance);
  if (!hit) return {};
  return FirstHit{hitOf(*hit, eye, direction), !rules().counts(hit->splat, direction)};
}

float GaussianSurfaces::alphaBefore(vec3 eye, vec3 direction, float distance_m) const {
  return 1 - tracer_->transmittance({eye, direction}, {.reach_m = distance_m});
}

float GaussianSurfaces::transmittance(vec3 origin, vec3 direction, float distance_m) const {
  return tracer_->transmittance({origin, direction}, rules(distance_m));
}

}  // namespace beam
