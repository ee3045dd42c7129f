// SPDX-License-Identifier: Apache-2.0
#include "core/render/path_integrator.h"

#include <algorithm>
#include <bit>

#include "core/math/brdf.h"
#include "core/math/sampling.h"

namespace beam {
namespace {

// Of [0, count): a Feistel network over the next even number of bits, walked until it is back inside.
std::uint64_t permuted(std::uint64_t i, std::uint64_t count, std::uint64_t key) {
  const int half = (std::bit_width(count - 1) + 1) / 2;
  const std::uint64_t mask = (1ull << half) - 1;
  do {
    std::uint64_t left = i >> half, right = i & mask;
    for (std::uint64_t round = 0; round < 4; ++round) {
      const std::uint64_t mixed = left ^ (mixBits(key + 4 * right + round) & mask);
      left = right;
      right = mixed;
    }
    i = left << half | right;
  } while (i >= count);
  return i;
}

bool isLit(vec3 c) { return c.x + c.y + c.z > 0; }

}  // namespace

PathNumbers::PathNumbers(std::uint64_t seed, std::uint64_t pixel, int sample, int samples, Strata strata)
    : random_(seed, pixel), sample_(sample), strata_(std::max(1, samples)), order_(strata) {}

vec2 PathNumbers::next() {
  const std::uint64_t d = dimension_++;
  const std::uint64_t shift = random_.bits(1000003 + d) % strata_;
  const float u = random_.uniform(2 * (d * 65537 + sample_)),
              v = random_.uniform(2 * (d * 65537 + sample_) + 1);
  const std::uint64_t place = order_ == Strata::Permuted
                                  ? permuted(sample_, strata_, random_.bits(2000003 + d))
                                  : (sample_ * (d % 2 ? 7 : 1) + shift) % strata_;
  const auto stratum = static_cast<float>(place);
  return {(stratum + u) / static_cast<float>(strata_), v};
}

PathIntegrator::Scattered PathIntegrator::scatter(const PathHit& h, vec3 n, vec3 wi, vec3 wo) const {
  const float cosine = glm::dot(n, wi), even = cosine / kPi;
  if (cosine <= 0) return {};
  if (!settings_.specular) return {h.base_color * even, even};
  const Reflectance r = reflectance(n, wi, wo, ggxAlpha(h.roughness));
  return {scattered(r, h.base_color, cosine),
          settings_.visible_normals ? 0.5f * (even + r.reflection_pdf) : even};
}

vec3 PathIntegrator::drawnBySurface(const PathHit& h, vec3 n, vec3 wo, PathNumbers& numbers) const {
  vec2 u = numbers.next();
  const Frame3 frame(n);
  if (settings_.visible_normals && settings_.specular) {
    const bool lobe = u.y < 0.5f;
    u.y = lobe ? 2 * u.y : 2 * u.y - 1;
    const vec3 eye = frame.toLocal(wo);
    if (lobe && eye.z > 0) {
      const vec3 half = visibleNormal(eye, ggxAlpha(h.roughness), u);
      return glm::normalize(frame.toWorld(2 * glm::dot(eye, half) * half - eye));
    }
  }
  return frame.toWorld(cosineDirection(u));
}

vec3 PathIntegrator::direct(const PathHit& h, vec3 n, vec3 wo, PathNumbers& numbers) const {
  vec3 sum(0);
  const vec3 o = nextFrom(h, n);
  const auto add = [&](const LightSample& s, vec3 wi, bool of_light) {
    const Scattered f = scatter(h, n, wi, wo);
    const float density = settings_.draws == LightDraws::Both ? s.pdf + f.pdf : of_light ? s.pdf : f.pdf;
    if (f.pdf <= 0 || density <= 0) return;
    const vec3 light = f.value * s.radiance / density;
    if (isLit(light)) sum += light * surfaces_.transmittance(o, wi, PathSurfaces::kFar_m);
  };
  const vec2 u = numbers.next();
  const vec3 wi = drawnBySurface(h, n, wo, numbers);
  if (settings_.draws != LightDraws::OfSurface) {
    const LightSample drawn = lights_.sample(u);
    add(drawn, drawn.direction, true);
  }
  if (settings_.draws != LightDraws::OfLights) add(lights_.at(wi), wi, false);
  return lights_.lamps().empty() ? sum : sum + lampLight(h, n, wo, wi, numbers);
}

// As of all light, each direction weighted by both densities; only a lamp draws where it has no extent.
vec3 PathIntegrator::lampLight(const PathHit& h, vec3 n, vec3 wo, vec3 by_surface,
                               PathNumbers& numbers) const {
  vec3 sum(0);
  const vec3 o = nextFrom(h, n);
  const auto add = [&](const PathLamp& lamp, const LampSample& s, bool of_light) {
    const Scattered f = scatter(h, n, s.toward, wo);
    const bool both = settings_.draws == LightDraws::Both;
    const float density = s.pdf <= 0 ? 1 : both ? s.pdf + f.pdf : of_light ? s.pdf : f.pdf;
    if (f.pdf <= 0 || density <= 0) return;
    const vec3 light = f.value * s.light / density;
    if (!isLit(light)) return;
    if (!lamp.shadows()) {
      sum += light;
    } else if (s.distance_m == PathSurfaces::kFar_m) {
      sum += light * surfaces_.transmittance(o, s.toward, s.distance_m);
    } else {
      const vec3 to = s.position_m - o;
      const float distance_m = std::max(glm::length(to), 1e-6f);
      sum += light * surfaces_.transmittance(o, to / distance_m, distance_m);
    }
  };
  for (const PathLamp& lamp : lights_.lamps()) {
    const vec2 u = lamp.wide() ? numbers.next() : vec2(0);
    if (!lamp.wide() || settings_.draws != LightDraws::OfSurface)
      add(lamp, lamp.sample(h.position_m, u), true);
    if (lamp.wide() && settings_.draws != LightDraws::OfLights)
      add(lamp, lamp.at(h.position_m, by_surface), false);
  }
  return sum;
}

PathRadiance PathIntegrator::trace(PathHit h, vec3 wo, PathNumbers& numbers) const {
  PathRadiance sum;
  vec3 throughput(1);
  for (int bounce = 0;; ++bounce) {
    const vec3 n = towards(wo, h.normal);
    sum.all += throughput * direct(h, n, wo, numbers);
    if (bounce == 0) sum.direct = sum.all;
    if (bounce == settings_.bounces) break;
    const vec3 wi = drawnBySurface(h, n, wo, numbers);
    const float cosine = glm::dot(n, wi);
    if (!(cosine > 1e-4f)) break;
    const Scattered f = scatter(h, n, wi, wo);
    throughput *= f.value * (settings_.visible_normals ? 1 / f.pdf : kPi / cosine);
    if (settings_.sure_bounces > 0 && bounce >= settings_.sure_bounces) {
      const float goes_on = std::min(1.0f, std::max({throughput.x, throughput.y, throughput.z}));
      if (!(numbers.next().x < goes_on)) break;
      throughput /= goes_on;
    }
    const std::optional<PathHit> next = surfaces_.nearest(nextFrom(h, n), wi, numbers.bits());
    if (!next) break;
    h = *next;
    wo = -wi;
  }
  return {glm::min(sum.all, vec3(settings_.brightest)), glm::min(sum.direct, vec3(settings_.brightest))};
}

float skyVisibility(const PathSurfaces& surfaces, vec3 x_m, vec3 normal, int samples, PathNumbers numbers) {
  int open = 0;
  const Frame3 frame(normal);
  const vec2 start = numbers.next();
  const R2Sequence sequence{static_cast<std::uint32_t>(start.x * 0x1p31f),
                            static_cast<std::uint32_t>(start.y * 0x1p31f)};
  for (int i = 0; i < samples; ++i) {
    open += surfaces.transmittance(x_m + PathSettings{}.offset_m * normal,
                                   frame.toWorld(cosineDirection(sequence(static_cast<std::uint32_t>(i)))),
                                   PathSurfaces::kFar_m) > 0;
  }
  return static_cast<float>(open) / static_cast<float>(samples);
}

}  // namespace beam
