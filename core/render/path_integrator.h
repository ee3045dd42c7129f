// SPDX-License-Identifier: Apache-2.0
// Light transport along paths, over two doors: what a ray meets (PathSurfaces) and where light comes from
// (PathLights). For whoever has surfaces with the paper's reflectance and wants a reference picture of them.
//
//   L(x, o) = sum over bounces k of T_k D(x_k),  T_0 = 1
//   D(x)    = integral over the hemisphere of f(i, o) L_light(i) V(x, i) (n.i) di
//   f       = base_color (1 - F) / pi + D G F / (4 (n.i)(n.o))       BEAM eq. 12 and 19, methods 5.4
//
// D by one direction of the lights' density and one of the surface's, with the balance heuristic: both count
// f L V (n.i) / (p_light + p_surface). p_surface is (n.i) / pi, or half of that and half the density of GGX's
// visible normals. T_k+1 = T_k f (n.i) / p_surface. World axes, metres; radiance in the units of the lights,
// scene-linear. Deterministic for the numbers of the path.
#pragma once

#include <limits>
#include <optional>
#include <span>

#include "core/base/rng.h"
#include "core/math/types.h"
#include "core/render/path_lamp.h"
#include "core/scene/environment.h"

namespace beam {

// What a ray meets first.
struct PathHit {
  vec3 position_m{0};
  vec3 normal{0};        // of shading, unit; of either side, it is turned towards the eye
  float distance_m = 0;  // along the ray
  vec3 base_color{0};    // linear, [0, 1]
  float roughness = 1;   // (0, 1]
  // From its position to where the next rays of the path begin; 0: PathSettings::offset_m along the normal.
  vec3 step_m{0};
};
// The side of a hit's normal that the eye sees.
inline vec3 towards(vec3 to_eye, vec3 normal) { return glm::dot(normal, to_eye) < 0 ? -normal : normal; }

class PathSurfaces {
 public:
  virtual ~PathSurfaces() = default;
  // `direction`: unit. `chance`: of this ray; a surface that stops light in part is met or not by it.
  virtual std::optional<PathHit> nearest(vec3 origin_m, vec3 direction, std::uint64_t chance) const = 0;
  // Of light from `distance_m`: 1 where nothing is in its way, 0 where it does not get through.
  virtual float transmittance(vec3 origin_m, vec3 direction, float distance_m) const = 0;
  static constexpr float kFar_m = std::numeric_limits<float>::infinity();
};

struct LightSample {
  vec3 direction{0, 1, 0};  // unit, to the light
  vec3 radiance{0};         // >= 0
  float pdf = 0;            // per steradian
};

class PathLights {
 public:
  virtual ~PathLights() = default;
  virtual LightSample sample(vec2 u) const = 0;      // u in [0, 1)^2
  virtual LightSample at(vec3 direction) const = 0;  // what `sample` gives where it draws `direction`
  // Beside light from everywhere; each is asked at every bounce.
  virtual std::span<const PathLamp> lamps() const { return {}; }
};

// A panorama as light from infinitely far, and lamps; keeps references. Null: there is no panorama.
class PanoramaLights final : public PathLights {
 public:
  explicit PanoramaLights(const EnvironmentSampler& sampler) : sampler_(&sampler) {}
  PanoramaLights(const EnvironmentSampler* sampler, std::span<const PathLamp> lamps)
      : sampler_(sampler), lamps_(lamps) {}
  LightSample sample(vec2 u) const override {
    return sampler_ ? of(sampler_->sample(u.x, u.y)) : LightSample{};
  }
  LightSample at(vec3 direction) const override {
    return sampler_ ? of(sampler_->at(direction)) : LightSample{.direction = direction};
  }
  std::span<const PathLamp> lamps() const override { return lamps_; }

 private:
  static LightSample of(const EnvironmentSampler::Sample& s) { return {s.direction, s.radiance, s.pdf}; }
  const EnvironmentSampler* sampler_;
  std::span<const PathLamp> lamps_;
};

// Uniform pairs in [0, 1)^2 of one path, a dimension each call. Over the `samples` of a pixel every dimension
// is stratified along its first axis. Shifted: each by a number of its own, which ties dimensions together: a
// mean over pixels is right, that of one pixel is not, however many samples. Permuted: each in an order of
// its own, and any first samples are spread over all strata.
enum class Strata { Shifted, Permuted };
class PathNumbers {
 public:
  PathNumbers(std::uint64_t seed, std::uint64_t pixel, int sample, int samples,
              Strata strata = Strata::Shifted);
  vec2 next();
  // 64 bits that no pair is made of, others at each call.
  std::uint64_t bits() { return random_.bits(~(sample_ * 65537 + chances_++)); }

 private:
  RandomStream random_;
  std::uint64_t sample_, strata_, dimension_ = 0, chances_ = 0;
  Strata order_;
};

// Which directions tell of light from the lights; either alone gives the same mean.
enum class LightDraws { Both, OfLights, OfSurface };

struct PathSettings {
  int bounces = 2;               // after the first hit; 0: light from the lights alone
  float offset_m = 3e-4f;        // of a path's next ray along the normal, so that it leaves its surface
  float brightest = 20;          // at most, of one path in a channel, against fireflies
  bool visible_normals = false;  // half of a surface's directions are drawn by its specular lobe
  // Bounces after which a path goes on with the probability of its throughput; 0: all of them do.
  int sure_bounces = 0;
  // --- What tests take apart ---
  bool specular = true;  // false: no lobe and no Fresnel, base colour / pi is left
  LightDraws draws = LightDraws::Both;
};

// Of one path.
struct PathRadiance {
  vec3 all{0};
  vec3 direct{0};  // of `all`: past no other surface
};

class PathIntegrator {
 public:
  // Keeps references to both.
  PathIntegrator(const PathSurfaces& surfaces, const PathLights& lights, const PathSettings& settings)
      : surfaces_(surfaces), lights_(lights), settings_(settings) {}

  // One path's estimate of what leaves `hit` towards the eye.
  PathRadiance trace(PathHit hit, vec3 to_eye, PathNumbers& numbers) const;
  vec3 radiance(const PathHit& hit, vec3 to_eye, PathNumbers& numbers) const {
    return trace(hit, to_eye, numbers).all;
  }

 private:
  // Reflectance times cosine, and p_surface.
  struct Scattered {
    vec3 value{0};
    float pdf = 0;
  };
  vec3 nextFrom(const PathHit& hit, vec3 normal) const {
    return hit.position_m + (hit.step_m == vec3(0) ? settings_.offset_m * normal : hit.step_m);
  }
  Scattered scatter(const PathHit& hit, vec3 normal, vec3 to_light, vec3 to_eye) const;
  vec3 drawnBySurface(const PathHit& hit, vec3 normal, vec3 to_eye, PathNumbers& numbers) const;
  vec3 direct(const PathHit& hit, vec3 normal, vec3 to_eye, PathNumbers& numbers) const;
  vec3 lampLight(const PathHit& hit, vec3 normal, vec3 to_eye, vec3 by_surface, PathNumbers& numbers) const;

  const PathSurfaces& surfaces_;
  const PathLights& lights_;
  PathSettings settings_;
};

// Cosine-weighted share of the sky that a point with this normal sees, [0, 1], by `samples` rays.
float skyVisibility(const PathSurfaces& surfaces, vec3 x_m, vec3 normal, int samples, PathNumbers numbers);

}  // namespace beam
