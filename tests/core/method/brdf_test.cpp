// SPDX-License-Identifier: Apache-2.0
// Laws of the light integrals with occluders in closed form (methods 11.1, 11.2).
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/rng.h"
#include "core/math/sampling.h"
#include "core/method/light_integrals.h"
#include "core/scene/capture.h"
#include "tests/core/method/function_tracer.h"

namespace beam {
namespace {

const FunctionTracer& openSky() {
  static const FunctionTracer tracer([](const Ray&) { return false; });
  return tracer;
}

Environment uniformLight(float radiance = 1) { return makeEnvironment(Image<vec3>(64, 32, vec3(radiance))); }

// A light with contrast: a bright window in a dim room.
Environment windowLight() {
  Image<vec3> map(64, 32, vec3(0.3f));
  for (int y = 6; y < 12; ++y) {
    for (int x = 20; x < 26; ++x) map(x, y) = vec3(20, 18, 15);
  }
  return makeEnvironment(std::move(map));
}

SurfacePoint pointSeenAt(float degrees) {
  const float t = degrees * kPi / 180;
  return {0, 0, vec3(0), vec3(0, 1, 0), vec3(std::sin(t), std::cos(t), 0)};
}

std::vector<LightIntegrals> integrate(std::span<const SurfacePoint> points, LightSampling sampling,
                                      const Environment& light, const Tracer& tracer) {
  Progress progress;
  return integrateLight(points, sampling, EnvironmentSampler(light), tracer, progress);
}

LightIntegrals many(const SurfacePoint& p, float roughness, const Environment& light, const Tracer& tracer) {
  return integrate(
      std::vector{p},
      {.cosine = 8000, .environment = 8000, .specular = 8000, .offset_m = 0, .roughness = roughness}, light,
      tracer)[0];
}

struct FurnaceRow {
  float roughness;
  double specular[4];  // at 0, 30, 60, 80 degrees
};

class Furnace : public ::testing::TestWithParam<FurnaceRow> {};

TEST_P(Furnace, GivesTheTabulatedIntegrals) {
  constexpr float kAngles[4] = {0, 30, 60, 80};
  constexpr double kDiffuse[4] = {0.9599, 0.9595, 0.9552, 0.9440};
  for (int a = 0; a < 4; ++a) {
    const LightIntegrals l = many(pointSeenAt(kAngles[a]), GetParam().roughness, uniformLight(), openSky());
    EXPECT_NEAR(l.specular.y, GetParam().specular[a], 0.01 * GetParam().specular[a] + 5e-5) << kAngles[a];
    EXPECT_NEAR(l.diffuse.y, kDiffuse[a], 0.005) << kAngles[a];
    EXPECT_FLOAT_EQ(l.sky, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods11_1, Furnace,
                         testing::Values(FurnaceRow{0.2f, {.0399, .0400, .0708, .3666}},
                                         FurnaceRow{0.3f, {.0396, .0398, .0701, .2773}},
                                         FurnaceRow{0.4f, {.0387, .0389, .0648, .1948}},
                                         FurnaceRow{0.5f, {.0367, .0367, .0557, .1382}},
                                         FurnaceRow{0.6f, {.0330, .0331, .0463, .1014}},
                                         FurnaceRow{0.7f, {.0280, .0283, .0382, .0774}},
                                         FurnaceRow{0.8f, {.0223, .0230, .0314, .0614}},
                                         FurnaceRow{1.0f, {.0123, .0136, .0209, .0422}}));

TEST(LightIntegrals, GiveTheClosedCaseOfBaseColor) {
  const LightIntegrals l = many(pointSeenAt(0), 0.5f, uniformLight(), openSky());
  EXPECT_NEAR((0.5f - l.specular.x) / l.diffuse.x, 0.4827, 0.001);
}

TEST(LightIntegrals, DoNotDependOnTheSplitOfStrategies) {
  const SurfacePoint p = pointSeenAt(40);
  const auto with = [&](int c, int e, int s) {
    return integrate(std::vector{p},
                     {.cosine = c, .environment = e, .specular = s, .offset_m = 0, .roughness = 0.4f},
                     windowLight(), openSky())[0];
  };
  const LightIntegrals reference = with(100000, 100000, 100000);
  for (const LightIntegrals& l : {with(200000, 0, 0), with(20000, 40000, 0), with(10000, 10000, 40000)}) {
    EXPECT_NEAR(l.diffuse.x, reference.diffuse.x, 0.02 * reference.diffuse.x);
    EXPECT_NEAR(l.specular.x, reference.specular.x, 0.02 * reference.specular.x);
  }
}

TEST(LightIntegrals, ScaleWithTheLight) {
  const SurfacePoint p = pointSeenAt(20);
  const LightIntegrals one = many(p, 0.5f, uniformLight(1), openSky()),
                       three = many(p, 0.5f, uniformLight(3), openSky());
  EXPECT_NEAR(three.diffuse.x, 3 * one.diffuse.x, 1e-3);
  EXPECT_NEAR(three.specular.x, 3 * one.specular.x, 1e-3);
}

TEST(LightIntegrals, AreTheSameForAnyOrderOfPointsAndSumOverWholeBlocks) {
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 300; ++i) points.push_back({i % 20, i / 20, vec3(0), vec3(0, 1, 0), vec3(0, 1, 0)});
  const FunctionTracer wall([](const Ray& r) { return r.direction.x > 0; });
  const auto forward = integrate(points, {}, windowLight(), wall);
  std::reverse(points.begin(), points.end());
  const auto backward = integrate(points, {}, windowLight(), wall);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(forward[i].diffuse, backward[points.size() - 1 - i].diffuse);
    EXPECT_EQ(forward[i].sky, backward[points.size() - 1 - i].sky);
  }
}

TEST(AmbientOcclusion, IsAHalfAtTheFootOfAnInfiniteWall) {
  const FunctionTracer wall([](const Ray& r) { return r.direction.x > 0; });
  EXPECT_NEAR(many(pointSeenAt(0), 0.5f, windowLight(), wall).sky, 0.5, 0.005);
}

TEST(AmbientOcclusion, FollowsAWallOfFiniteHeight) {
  const float h = 1, d = 0.7f;
  const FunctionTracer wall(
      [=](const Ray& r) { return r.direction.x > 0 && r.direction.y * d < h * r.direction.x; });
  EXPECT_NEAR(many(pointSeenAt(0), 0.5f, uniformLight(), wall).sky, (1 + d / std::hypot(d, h)) / 2, 0.005);
}

TEST(AmbientOcclusion, FollowsASphereOverhead) {
  const float radius = 0.5f, height = 1.2f;
  const FunctionTracer sphere([=](const Ray& r) {
    return r.direction.y > 0 && height * height * (1 - r.direction.y * r.direction.y) < radius * radius;
  });
  EXPECT_NEAR(many(pointSeenAt(0), 0.5f, uniformLight(), sphere).sky,
              1 - (radius * radius) / (height * height), 0.005);
}

TEST(AmbientOcclusion, IsSineSquaredInAnOpenCone) {
  const float theta = 0.8f;
  const FunctionTracer cone([=](const Ray& r) { return r.direction.y < std::cos(theta); });
  EXPECT_NEAR(many(pointSeenAt(0), 0.5f, windowLight(), cone).sky, std::sin(theta) * std::sin(theta), 0.005);
}

// Random directions would give 0.5 / sqrt(50) = 0.071 at A = 1/2 (methods 5.3).
TEST(AmbientOcclusion, FromTheSharedRaysIsAsGoodAsFiftyStratifiedOnes) {
  for (const Environment& light : {uniformLight(), windowLight()}) {
    const RandomStream random(3);
    double square = 0;
    const int count = 2000;
    for (int i = 0; i < count; ++i) {
      const float turn = 2 * kPi * random.uniform(i);
      const vec3 side(std::cos(turn), 0, std::sin(turn));
      const FunctionTracer wall([=](const Ray& r) { return glm::dot(r.direction, side) > 0; });
      SurfacePoint p = pointSeenAt(0);
      p.x = 4 * i;
      square += std::pow(integrate(std::vector{p}, {.offset_m = 0}, light, wall)[0].sky - 0.5, 2);
    }
    EXPECT_LT(std::sqrt(square / count), 0.04);
  }
}

TEST(RayOffset, StartsTheRayAlongTheNormal) {
  const FunctionTracer probe([](const Ray& r) {
    EXPECT_NEAR(glm::length(r.origin - vec3(0, 0.05f, 0)), 0, 1e-6);
    return false;
  });
  integrate(std::vector{pointSeenAt(0)}, {.offset_m = 0.05f}, uniformLight(), probe);
}

// A panorama with one bright texel lights the side of a ball that the data sets' own formula names: d = (cos
// el cos az, cos el sin az, sin el), az = pi - 2 pi u, el = pi/2 - pi v in a capture with +Z up.
TEST(OneBrightTexel, LightsTheSideThatTheCaptureStates) {
  const dmat3 world_from_capture = worldFromCapture(UpAxis::PlusZ);
  for (const ivec2& texel : {ivec2(3, 10), ivec2(20, 5), ivec2(31, 8), ivec2(50, 12)}) {
    Image<vec3> map(64, 32, vec3(0.01f));
    map(texel.x, texel.y) = vec3(500);
    const double az = kPi - 2 * kPi * (texel.x + 0.5) / 64, el = kPi / 2 - kPi * (texel.y + 0.5) / 32;
    const vec3 lamp(world_from_capture *
                    dvec3(std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el)));
    std::vector<SurfacePoint> ball;
    const RandomStream random(5);
    for (std::uint64_t i = 0; i < 500; ++i) {
      const vec3 n =
          glm::normalize(vec3(random.normal(3 * i), random.normal(3 * i + 1), random.normal(3 * i + 2)));
      ball.push_back({static_cast<int>(i), 0, n, n, n});
    }
    const auto lit = integrate(ball, {}, makeEnvironment(map), openSky());
    std::size_t best = 0;
    for (std::size_t i = 0; i < lit.size(); ++i) best = lit[i].diffuse.x > lit[best].diffuse.x ? i : best;
    EXPECT_GT(glm::dot(ball[best].normal, lamp), 0.97f) << texel.x << " " << texel.y;
    // Lambert: proportional to the cosine on the lit side.
    const float full = lit[best].diffuse.x / glm::dot(ball[best].normal, lamp);
    for (std::size_t i = 0; i < lit.size(); ++i) {
      EXPECT_NEAR(lit[i].diffuse.x, std::max(0.0f, glm::dot(ball[i].normal, lamp)) * full, 0.12f * full);
    }
  }
}

}  // namespace
}  // namespace beam
