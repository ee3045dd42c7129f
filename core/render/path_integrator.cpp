// SPDX-License-Identifier: Apache-2.0
#include "core/render/path_integrator.h"

#include <algorithm>

#include "core/math/brdf.h"
#include "core/math/sampling.h"

namespace beam {
namespace {

// Reflectance times cosine.
vec3 scatter(const PathHit& h, vec3 n, vec3 wi, vec3 wo) {
  const float cosine = glm::dot(n, wi);
  if (cosine <= 0) return vec3(0);
  const Reflectance r = reflectance(n, wi, wo, ggxAlpha(h.roughness));
  return (h.base_color * ((1 - r.fresnel) / kPi) + vec3(r.specular)) * cosine;
}

bool isLit(vec3 c) { return c.x + c.y + c.z > 0; }

}  // namespace

PathNumbers::PathNumbers(std::uint64_t seed, std::uint64_t pixel, int sample, int samples)
    : random_(seed, pixel), sample_(sample), strata_(std::max(1, samples)) {}

vec2 PathNumbers::next() {
  const std::uint64_t d = dimension_++;
  const std::uint64_t shift = random_.bits(1000003 + d) % strata_;
  const float u = random_.uniform(2 * (d * 65537 + sample_)),
              v = random_.uniform(2 * (d * 65537 + sample_) + 1);
  const auto stratum = static_cast<float>((sample_ * (d % 2 ? 7 : 1) + shift) % strata_);
  return {(stratum + u) / static_cast<float>(strata_), v};
}

vec3 PathIntegrator::direct(const PathHit& h, vec3 n, vec3 wo, PathNumbers& numbers) const {
  vec3 sum(0);
  const vec3 o = h.position_m + settings_.offset_m * n;
  const vec2 u = numbers.next(), c = numbers.next();
  const auto add = [&](const LightSample& s, vec3 wi) {
    const float cosine = glm::dot(n, wi);
    if (cosine <= 0 || s.pdf + cosine <= 0) return;
    const vec3 f = scatter(h, n, wi, wo) * s.radiance / (s.pdf + cosine / kPi);
    if (isLit(f) && !surfaces_.occluded(o, wi)) sum += f;
  };
  const LightSample drawn = lights_.sample(u);
  add(drawn, drawn.direction);
  const vec3 wi = Frame3(n).toWorld(cosineDirection(c));
  add(lights_.at(wi), wi);
  return sum;
}

vec3 PathIntegrator::radiance(PathHit h, vec3 wo, PathNumbers& numbers) const {
  vec3 sum(0), throughput(1);
  for (int bounce = 0;; ++bounce) {
    const vec3 n = glm::dot(h.normal, wo) < 0 ? -h.normal : h.normal;
    sum += throughput * direct(h, n, wo, numbers);
    if (bounce == settings_.bounces) break;
    const vec3 wi = Frame3(n).toWorld(cosineDirection(numbers.next()));
    const float cosine = glm::dot(n, wi);
    if (cosine <= 1e-4f) break;
    throughput *= scatter(h, n, wi, wo) * (kPi / cosine);
    const std::optional<PathHit> next = surfaces_.nearest(h.position_m + settings_.offset_m * n, wi);
    if (!next) break;
    h = *next;
    wo = -wi;
  }
  return glm::min(sum, vec3(settings_.brightest));
}

float skyVisibility(const PathSurfaces& surfaces, vec3 x_m, vec3 normal, int samples, PathNumbers numbers) {
  int open = 0;
  const Frame3 frame(normal);
  const vec2 start = numbers.next();
  const R2Sequence sequence{static_cast<std::uint32_t>(start.x * 0x1p31f),
                            static_cast<std::uint32_t>(start.y * 0x1p31f)};
  for (int i = 0; i < samples; ++i) {
    open += !surfaces.occluded(x_m + PathSettings{}.offset_m * normal,
                               frame.toWorld(cosineDirection(sequence(static_cast<std::uint32_t>(i)))));
  }
  return static_cast<float>(open) / static_cast<float>(samples);
}

}  // namespace beam
