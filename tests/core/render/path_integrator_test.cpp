// SPDX-License-Identifier: Apache-2.0
// Laws of the path integrator behind doors of a few lines: the furnace's geometric series, a plane under a
// cap of light, and what is occluded.
#include "core/render/path_integrator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/math/brdf.h"

namespace beam {
namespace {

// Light of one radiance from all directions that `lit` names; drawn evenly over the sphere.
struct EvenLight final : PathLights {
  std::function<bool(vec3)> lit = [](vec3) { return true; };
  LightSample sample(vec2 u) const override {
    const float z = 1 - 2 * u.y, r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * kPi * u.x;
    return at({r * std::cos(phi), r * std::sin(phi), z});
  }
  LightSample at(vec3 d) const override { return {d, vec3(lit(d) ? 1.0f : 0.0f), 1 / (4 * kPi)}; }
};

// Wherever a path goes it meets the same wall, face on, and light comes through the walls.
struct Furnace final : PathSurfaces {
  PathHit wall;
  std::optional<PathHit> nearest(vec3 o, vec3 d, std::uint64_t) const override {
    PathHit h = wall;
    h.position_m = o + d;
    h.normal = -d;
    return h;
  }
  float transmittance(vec3, vec3, float) const override { return 1; }
};

// The plane y = 0 and nothing else; `shade` names the directions that something stands in.
struct Plane final : PathSurfaces {
  PathHit floor;
  std::function<bool(vec3)> shade = [](vec3) { return false; };
  std::optional<PathHit> nearest(vec3 o, vec3 d, std::uint64_t) const override {
    PathHit h = floor;
    h.distance_m = -o.y / d.y;
    if (!(h.distance_m > 0)) return {};
    h.position_m = o + h.distance_m * d;
    return h;
  }
  float transmittance(vec3 o, vec3 d, float) const override {
    return nearest(o, d, 0) || shade(d) ? 0.0f : 1.0f;
  }
};

PathHit material(vec3 base_color, float roughness) {
  return {.normal = vec3(0, 1, 0), .base_color = base_color, .roughness = roughness};
}

// 2 pi times the integral of f cos sin over [0, angle] from the normal, seen face on.
dvec3 reflected(const PathHit& m, double angle) {
  constexpr int kSteps = 20000;
  dvec3 sum(0);
  for (int i = 0; i < kSteps; ++i) {
    const double t = angle * (i + 0.5) / kSteps;
    const vec3 wi(static_cast<float>(std::sin(t)), static_cast<float>(std::cos(t)), 0);
    const Reflectance r = reflectance(vec3(0, 1, 0), wi, vec3(0, 1, 0), ggxAlpha(m.roughness));
    const dvec3 f = dvec3(m.base_color) * ((1.0 - r.fresnel) / kPi) + static_cast<double>(r.specular);
    sum += f * (2 * kPi * std::cos(t) * std::sin(t) * angle / kSteps);
  }
  return sum;
}

struct Estimate {
  dvec3 mean{0};
  double error = 0;  // of the mean, one standard deviation, the largest channel's
};
// Over pixels: the dimensions of the paths of one pixel are shifted against each other, not independent.
Estimate estimate(const PathSurfaces& surfaces, const PathLights& lights, const PathHit& hit, int bounces) {
  constexpr int kPixels = 6000, kSamples = 16;
  const PathIntegrator paths(surfaces, lights, {.bounces = bounces, .brightest = 1e6f});
  dvec3 sum(0), squares(0);
  for (int p = 0; p < kPixels; ++p) {
    dvec3 pixel(0);
    for (int i = 0; i < kSamples; ++i) {
      PathNumbers numbers(5, p, i, kSamples);
      pixel += dvec3(paths.radiance(hit, vec3(0, 1, 0), numbers)) / static_cast<double>(kSamples);
    }
    sum += pixel, squares += pixel * pixel;
  }
  const dvec3 mean = sum / static_cast<double>(kPixels);
  const dvec3 variance = squares / static_cast<double>(kPixels) - mean * mean;
  return {mean, std::sqrt(std::max({variance.x, variance.y, variance.z}) / kPixels)};
}
void expectNear(const Estimate& found, dvec3 expected) {
  EXPECT_LT(found.error, 0.004 * expected.x);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.mean[c], expected[c], 4 * found.error + 1e-4 * expected[c]) << c;
  }
}

TEST(PathIntegrator, InAFurnaceBouncesAddUpToTheGeometricSeries) {
  Furnace furnace;
  const EvenLight light;
  furnace.wall = material(vec3(0.8f, 0.5f, 0.2f), 0.9f);
  const dvec3 albedo = reflected(furnace.wall, kPi / 2);
  dvec3 series(0), power(1);
  for (int bounces = 0; bounces < 6; ++bounces) {
    power *= albedo;
    series += power;
    expectNear(estimate(furnace, light, furnace.wall, bounces), series);
  }
}

TEST(PathIntegrator, InAFurnaceWithoutEndItGivesAlbedoOverOneMinusAlbedo) {
  Furnace furnace;
  const EvenLight light;
  furnace.wall = material(vec3(0.6f, 0.4f, 0.1f), 1);
  const dvec3 albedo = reflected(furnace.wall, kPi / 2);
  expectNear(estimate(furnace, light, furnace.wall, 40), albedo / (1.0 - albedo));
}

TEST(PathIntegrator, APlaneUnderACapOfLightReflectsItsIntegralHoweverManyBounces) {
  Plane plane;
  plane.floor = material(vec3(0.7f, 0.3f, 0.5f), 0.6f);
  EvenLight light;
  const double angle = 1.1;
  light.lit = [&](vec3 d) { return d.y > std::cos(angle); };
  for (const int bounces : {0, 3}) {
    expectNear(estimate(plane, light, plane.floor, bounces), reflected(plane.floor, angle));
  }
}

TEST(PathIntegrator, HalfASkyBehindAWallIsHalfTheLight) {
  Plane plane;
  plane.floor = material(vec3(0.7f, 0.3f, 0.5f), 0.6f);
  plane.shade = [](vec3 d) { return d.x < 0; };
  expectNear(estimate(plane, EvenLight(), plane.floor, 0), 0.5 * reflected(plane.floor, kPi / 2));
  EXPECT_NEAR(skyVisibility(plane, vec3(0), vec3(0, 1, 0), 4096, PathNumbers(1, 0, 0, 1)), 0.5, 0.01);
}

TEST(PathIntegrator, SeesASurfaceFromBehindAsFromTheFront) {
  Plane plane;
  plane.floor = material(vec3(0.7f, 0.3f, 0.5f), 0.6f);
  PathHit turned = plane.floor;
  turned.normal = -turned.normal;
  const EvenLight light;
  EXPECT_EQ(estimate(plane, light, turned, 1).mean, estimate(plane, light, plane.floor, 1).mean);
}

TEST(PathIntegrator, NoPathIsBrighterThanTheLimit) {
  Furnace furnace;
  furnace.wall = material(vec3(1), 1);
  const EvenLight light;
  const PathIntegrator paths(furnace, light, {.bounces = 200, .brightest = 3});
  PathNumbers numbers(1, 0, 0, 1);
  EXPECT_EQ(paths.radiance(furnace.wall, vec3(0, 1, 0), numbers), vec3(3));
}

TEST(PanoramaLights, GiveOfADirectionWhatTheyGaveWhenTheyDrewIt) {
  Environment e = makeEnvironment(Image<vec3>(8, 4, vec3(0.5f), Encoding::Linear));
  e.radiance(3, 1) = vec3(9, 4, 1);
  const EnvironmentSampler sampler(e);
  const PanoramaLights lights(sampler);
  for (int i = 0; i < 50; ++i) {
    const RandomStream random(2, i);
    const LightSample drawn = lights.sample({random.uniform(0), random.uniform(1)});
    const LightSample seen = lights.at(drawn.direction);
    EXPECT_EQ(drawn.radiance, seen.radiance);
    EXPECT_FLOAT_EQ(drawn.pdf, seen.pdf);
  }
}

TEST(PathNumbers, FillEveryStratumOnceInEveryDimension) {
  constexpr int kSamples = 16;
  for (int dimension = 0; dimension < 4; ++dimension) {
    std::vector<int> hits(kSamples);
    for (int i = 0; i < kSamples; ++i) {
      PathNumbers numbers(3, 11, i, kSamples);
      vec2 u(0);
      for (int d = 0; d <= dimension; ++d) u = numbers.next();
      ++hits[static_cast<std::size_t>(u.x * kSamples)];
    }
    EXPECT_EQ(hits, std::vector<int>(kSamples, 1)) << dimension;
  }
}

TEST(PathNumbers, PermutedFillEveryStratumOnceAndTieNoDimensions) {
  for (const int samples : {1, 7, 24, 128}) {
    for (int dimension = 0; dimension < 5; ++dimension) {
      std::vector<int> hits(static_cast<std::size_t>(samples));
      for (int i = 0; i < samples; ++i) {
        PathNumbers numbers(3, 11, i, samples, Strata::Permuted);
        vec2 u(0);
        for (int d = 0; d <= dimension; ++d) u = numbers.next();
        ++hits[static_cast<std::size_t>(u.x * static_cast<float>(samples))];
      }
      EXPECT_EQ(hits, std::vector<int>(static_cast<std::size_t>(samples), 1)) << samples << " " << dimension;
    }
  }
  // Of one pixel: how often two dimensions add up to less than 1.
  constexpr int kSamples = 4096;
  for (std::uint64_t pixel = 0; pixel < 8; ++pixel) {
    int below = 0;
    for (int i = 0; i < kSamples; ++i) {
      PathNumbers numbers(3, pixel, i, kSamples, Strata::Permuted);
      const float a = numbers.next().x;
      numbers.next();
      below += a + numbers.next().x < 1;
    }
    EXPECT_NEAR(below / double{kSamples}, 0.5, 0.03) << pixel;
  }
}

TEST(PathNumbers, TheFirstPermutedSamplesAreSpreadOverAll) {
  int low = 0;
  for (std::uint64_t pixel = 0; pixel < 200; ++pixel) {
    for (int i = 0; i < 8; ++i) low += PathNumbers(1, pixel, i, 128, Strata::Permuted).next().x < 0.5f;
  }
  EXPECT_NEAR(low / 1600.0, 0.5, 0.05);
}

}  // namespace
}  // namespace beam
