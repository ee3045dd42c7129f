// SPDX-License-Identifier: Apache-2.0
// Visibility of Gaussians: which side is the outer one and where it is seen, closed forms of open and
// shadowed surfaces, and the light that arrives against rays that are traced one by one.
#include "core/method/bake_visibility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/sampling.h"
#include "core/render/light_transfer.h"
#include "core/render/prepared_light.h"
#include "core/scene/thin_axis.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam {
namespace {

// A sky that is brighter to one side, and a warm ground.
Environment slopedSky() {
  Image<vec3> map(64, 32, vec3(0), Encoding::Linear);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const vec3 d = directionFromLatLong({(x + 0.5f) / 64, (y + 0.5f) / 32});
      map(x, y) = d.y > 0 ? vec3(0.6f, 0.8f, 1.0f) * (1.2f + d.x) : vec3(0.4f, 0.3f, 0.2f);
    }
  }
  return makeEnvironment(std::move(map));
}

std::vector<Camera> camerasAround(dvec3 target, double distance_m) {
  std::vector<Camera> cameras;
  for (int i = 0; i < 24; ++i) {
    const double z = 1 - (2 * i + 1.0) / 24, r = std::sqrt(1 - z * z), phi = 2.39996323 * i;
    cameras.push_back(testing::cameraLookingAt(
        target + distance_m * dvec3(r * std::cos(phi), z, r * std::sin(phi)), target, 160, 200));
  }
  return cameras;
}

SeenSurface seen(const GaussianCloud& cloud, std::span<const Camera> cameras) {
  const auto device = makeCpuDevice();
  Progress progress;
  return seenSurface(cloud, cameras, *device, progress);
}

// As its shapes were made: no camera tells of them.
SeenSurface madeOf(const GaussianCloud& cloud) {
  SeenSurface surface{{}, cloud.position_m};
  for (const quat& q : cloud.rotation) surface.normal.push_back(glm::mat3_cast(q)[2]);
  return surface;
}

ShBlock baked(const GaussianCloud& cloud, const SeenSurface& surface,
              const BakeVisibilityOptions& options = {.offset_m = 0.01}) {
  const auto device = makeCpuDevice();
  Progress progress;
  return bakeVisibility(cloud, surface, options, *device, progress);
}

Visibility visibilityOf(const ShBlock& block, std::size_t i) {
  Visibility v;
  std::copy_n(block.of(i), kShCount, v.begin());
  return v;
}

TEST(SeenSurface, NormalsOfTwoBodiesPointOutOfEach) {
  GaussianCloud cloud;
  testing::addSphere(cloud, vec3(-0.25f, 0, 0), 0.2f, 500);
  const std::size_t first = cloud.size();
  testing::addSphere(cloud, vec3(0.25f, 0, 0), 0.2f, 500);
  const SeenSurface surface = seen(cloud, camerasAround(dvec3(0), 2));
  int outward = 0, away_from_the_middle = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const vec3 middle = vec3(i < first ? -0.25f : 0.25f, 0, 0), out = cloud.position_m[i] - middle;
    outward += glm::dot(surface.normal[i], out) > 0;
    away_from_the_middle += glm::dot(outwardAxis(cloud, i, centerOf(cloud)), out) > 0;
  }
  EXPECT_EQ(outward, static_cast<int>(cloud.size()));
  EXPECT_LE(away_from_the_middle, 900) << "the case does not tell the two apart";
}

TEST(SeenSurface, LiftsWhatLiesUnderTheSurfaceOntoIt) {
  GaussianCloud cloud;
  testing::addRectangle(cloud, vec3(0), vec3(0, 0, 0.3f), vec3(0.3f, 0, 0), 0.02f);
  for (float& o : cloud.opacity) o = 0.7f;  // so that what is under it is seen a little
  const std::size_t under = cloud.size();
  testing::addSplat(cloud, vec3(0.005f, -0.006f, 0.005f), vec3(0, 1, 0), 0.01f, 0.001f);
  const std::vector<Camera> above = {testing::cameraLookingAt({0, 1, 0.01}, {0, 0, 0}, 160, 200)};
  const SeenSurface surface = seen(cloud, above);
  EXPECT_NEAR(surface.position_m[under].y, 0, 0.0015);
  EXPECT_NEAR(surface.position_m[0].y, 0, 0.0015);
}

TEST(SeenSurface, WhatNobodySeesStaysWhereItIs) {
  GaussianCloud cloud;
  testing::addSphere(cloud, vec3(0), 0.2f, 400);
  testing::addSplat(cloud, vec3(0, 0.1f, 0), vec3(0, -1, 0), 0.005f, 0.001f);
  const SeenSurface surface = seen(cloud, camerasAround(dvec3(0), 1));
  EXPECT_EQ(surface.position_m.back(), vec3(0, 0.1f, 0));
  EXPECT_NEAR(surface.normal.back().y, 1, 1e-6) << "away from the middle of the cloud";
}

TEST(BakeVisibility, OfAConvexBodyGivesTheOpenIrradiance) {
  GaussianCloud cloud;
  testing::addSphere(cloud, vec3(0), 0.4f, 1500);
  const SeenSurface surface = madeOf(cloud);
  const ShBlock visibility = baked(cloud, surface);
  const PreparedLight light = prepareLight(slopedSky());
  for (std::size_t i = 0; i < cloud.size(); i += 7) {
    const vec3 open = irradiance(light, surface.normal[i]);
    const vec3 got = seenIrradiance(light.transfer, surface.normal[i], visibilityOf(visibility, i), open);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / open[c], 1, 0.01) << i;
  }
}

// Light past the tracer's own rays, many of them, in place of the SH.
vec3 tracedIrradiance(const Tracer& tracer, const Environment& sky, vec3 x, vec3 n, float offset_m) {
  constexpr int kRays = 8192;
  std::vector<Ray> rays;
  const Frame3 frame(n);
  for (std::uint32_t i = 0; i < kRays; ++i)
    rays.push_back({x + offset_m * n, frame.toWorld(cosineDirection(R2Sequence{}(i)))});
  std::vector<std::uint8_t> blocked(rays.size());
  tracer.occluded(rays, blocked);
  dvec3 sum(0);
  for (int i = 0; i < kRays; ++i)
    if (!blocked[i]) sum += dvec3(radianceFrom(sky, rays[i].direction));
  return vec3(sum * (static_cast<double>(kPi) / kRays));
}

struct Difference {
  double mean = 0, worst = 0;  // of E_V, as a share of the open E
  double occlusion_alone = 0;  // mean of the paper's form: E times the share of open cosine
};

// Of the Gaussians from `first` on, a few.
Difference differenceFrom(const GaussianCloud& cloud, std::size_t first, std::size_t last) {
  const Environment sky = slopedSky();
  const PreparedLight light = prepareLight(sky),
                      white = prepareLight(makeEnvironment(Image<vec3>(64, 32, vec3(1))));
  const SeenSurface surface = madeOf(cloud);
  const ShBlock visibility = baked(cloud, surface);
  const auto tracer = makeCpuDevice()->newTracer({}, cloud);
  Difference d;
  int count = 0;
  for (std::size_t i = first; i < last; i += 5) {
    const vec3 n = surface.normal[i], open = irradiance(light, n);
    const float all = irradiance(white, n).x;
    const vec3 truth = tracedIrradiance(*tracer, sky, cloud.position_m[i], n, 0.01f);
    const vec3 got = seenIrradiance(light.transfer, n, visibilityOf(visibility, i), open);
    const float sky_share = seenIrradiance(white.transfer, n, visibilityOf(visibility, i), vec3(all)).x / all;
    const double error = glm::length(got - truth) / glm::length(open);
    d.mean += error;
    d.occlusion_alone += glm::length(sky_share * open - truth) / glm::length(open);
    d.worst = std::max(d.worst, error);
    ++count;
  }
  d.mean /= count;
  d.occlusion_alone /= count;
  return d;
}

TEST(BakeVisibility, UnderADiscAPlateGetsTheLightThatRaysFind) {
  GaussianCloud cloud;
  testing::addRectangle(cloud, vec3(0), vec3(0, 0, 0.4f), vec3(0.4f, 0, 0), 0.02f);
  const std::size_t plate = cloud.size();
  for (int i = 0; i < 400; ++i) {  // a disc of radius 0.2 m
    const float r = 0.2f * std::sqrt((i + 0.5f) / 400), phi = 2.39996323f * i;
    testing::addSplat(cloud, vec3(r * std::cos(phi), 0.2f, r * std::sin(phi)), vec3(0, 1, 0), 0.02f, 0.001f);
  }
  const Difference d = differenceFrom(cloud, 0, plate);
  EXPECT_LT(d.mean, 0.025);
  EXPECT_LT(d.worst, 0.12);
  EXPECT_LT(d.mean, 0.5 * d.occlusion_alone);
}

TEST(BakeVisibility, BesideAnArmATorsoGetsTheLightThatRaysFind) {
  GaussianCloud cloud;
  testing::addSphere(cloud, vec3(0), 0.25f, 1500);
  const std::size_t torso = cloud.size();
  for (int i = 0; i < 5; ++i) testing::addSphere(cloud, vec3(0.38f, 0.1f * i - 0.2f, 0), 0.08f, 250);
  const Difference d = differenceFrom(cloud, 0, torso);
  EXPECT_LT(d.mean, 0.02);
  EXPECT_LT(d.worst, 0.2);
  EXPECT_LT(d.mean, 0.7 * d.occlusion_alone);
}

TEST(BakeVisibility, IsTheSameForAnyNumberOfThreads) {
  GaussianCloud cloud;
  testing::addSphere(cloud, vec3(0), 0.3f, 600);
  testing::addSphere(cloud, vec3(0.4f, 0, 0), 0.1f, 200);
  const SeenSurface surface = seen(cloud, camerasAround(dvec3(0), 2));
  const ShBlock all = baked(cloud, surface);
  setThreadCount(1);
  const SeenSurface again = seen(cloud, camerasAround(dvec3(0), 2));
  const ShBlock one = baked(cloud, again);
  setThreadCount(0);
  EXPECT_EQ(surface.normal, again.normal);
  EXPECT_EQ(surface.position_m, again.position_m);
  EXPECT_EQ(all.coefficients, one.coefficients);
}

TEST(BakeVisibility, EndsWhenItIsStopped) {
  GaussianCloud cloud;
  testing::addSphere(cloud, vec3(0), 0.3f, 600);
  std::stop_source stop;
  stop.request_stop();
  Progress progress(stop.get_token());
  const auto device = makeCpuDevice();
  EXPECT_THROW(bakeVisibility(cloud, madeOf(cloud), {}, *device, progress), Cancelled);
}

}  // namespace
}  // namespace beam
