// SPDX-License-Identifier: Apache-2.0
// Visibility: the cases of methods 11.3, closed forms of 11.2 on occluders of overlapping splats,
// independence of order, and a brute-force loop.
#include "core/render/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/rng.h"
#include "core/math/sampling.h"
#include "core/render/device.h"

namespace beam {
namespace {

void add(GaussianCloud& c, vec3 x, quat q, vec3 s, float o) {
  c.position_m.push_back(x);
  c.rotation.push_back(q);
  c.scale_m.push_back(s);
  c.opacity.push_back(o);
  c.color.coefficients.resize(c.size() * kShCount * 3, 0.0f);
}

bool blocked(const GaussianCloud& c, const Ray& ray, TracerDesc desc = {}) {
  const auto tracer = makeCpuDevice()->newTracer(desc, c);
  std::uint8_t b = 0;
  tracer->occluded(std::span(&ray, 1), std::span(&b, 1));
  return b != 0;
}

const Ray kAlongX{{-1, 0, 0}, {1, 0, 0}};

TEST(Visibility, OneSplatNeverBlocks) {
  GaussianCloud c;
  add(c, {0, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.99f);
  EXPECT_FALSE(blocked(c, kAlongX));
}

TEST(Visibility, TwoAtSixTenthsBlock) {
  GaussianCloud c;
  add(c, {0, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.6f);
  add(c, {0.3f, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.6f);
  EXPECT_TRUE(blocked(c, kAlongX));
}

TEST(Visibility, WhatLiesBehindTheOriginDoesNotCount) {
  GaussianCloud c;
  for (const float x : {-2.0f, -2.3f}) add(c, {x, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.9f);
  EXPECT_FALSE(blocked(c, kAlongX));
}

TEST(Visibility, SplatsThatHoldTheOriginAreIgnoredUnlessAskedFor) {
  GaussianCloud c;
  for (const float x : {-0.95f, -0.9f}) add(c, {x, 0, 0}, {1, 0, 0, 0}, vec3(0.2f), 0.9f);
  EXPECT_FALSE(blocked(c, kAlongX));
  EXPECT_TRUE(blocked(c, kAlongX, {.ignore_containing = false}));
}

GaussianCloud randomCloud(std::size_t n) {
  GaussianCloud c;
  for (std::size_t i = 0; i < n; ++i) {
    const RandomStream r(3, i);
    add(c, 0.5f * vec3(r.normal(0), r.normal(1), r.normal(2)),
        glm::normalize(quat(r.normal(3), r.normal(4), r.normal(5), r.normal(6))),
        vec3(0.02f, 0.08f * r.uniform(7) + 0.01f, 0.05f), 0.2f + 0.7f * r.uniform(8));
  }
  return c;
}

Ray randomRay(int i) {
  const RandomStream r(8, i);
  return {vec3(r.normal(0), r.normal(1), r.normal(2)),
          glm::normalize(vec3(r.normal(3), r.normal(4), r.normal(5)))};
}

// Every Gaussian on every ray, in double.
double slowSum(const GaussianCloud& c, const Ray& ray, const TracerDesc& d) {
  double sum = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const dmat3 m = glm::transpose(glm::mat3_cast(dquat(c.rotation[i])));
    const dvec3 s(c.scale_m[i]), o = m * (dvec3(ray.origin) - dvec3(c.position_m[i])) / s,
                                 dir = m * dvec3(ray.direction) / s;
    const double cut2 = 2 * std::log(c.opacity[i] / d.cut_response), along = glm::dot(o, dir);
    if (cut2 <= 0 || along >= 0 || (d.ignore_containing && glm::dot(o, o) < cut2)) continue;
    const dvec3 across = glm::cross(o, dir);
    const double r2 = glm::dot(across, across) / glm::dot(dir, dir);
    if (r2 < cut2) sum += c.opacity[i] * std::exp(-0.5 * r2);
  }
  return sum;
}

TEST(Visibility, SumsWhatTheBruteForceLoopSums) {
  const GaussianCloud c = randomCloud(400);
  const auto tracer = makeCpuDevice()->newTracer({}, c);
  for (int i = 0; i < 300; ++i) {
    const double got = static_cast<double>(tracer->alphaSum(randomRay(i))) / (1 << 20);
    EXPECT_NEAR(got, slowSum(c, randomRay(i), {}), 2e-3 + 0.012 * 2) << i;
  }
}

TEST(Visibility, DoesNotDependOnTheOrderOfTheSplats) {
  const GaussianCloud c = randomCloud(400);
  GaussianCloud reversed;
  for (std::size_t i = c.size(); i-- > 0;)
    add(reversed, c.position_m[i], c.rotation[i], c.scale_m[i], c.opacity[i]);
  const auto a = makeCpuDevice()->newTracer({}, c), b = makeCpuDevice()->newTracer({}, reversed);
  for (int i = 0; i < 300; ++i) EXPECT_EQ(a->alphaSum(randomRay(i)), b->alphaSum(randomRay(i)));
}

// A sheet of overlapping splats with normal +X through (x, ., .), rows of y in [0, height], z wide.
void addWall(GaussianCloud& c, float x, float height) {
  const float spacing = 0.02f;
  for (float y = spacing / 2; y < height; y += spacing) {
    for (float z = -3; z < 3; z += spacing)
      add(c, {x, y, z}, {1, 0, 0, 0}, {0.002f, spacing, spacing}, 0.95f);
  }
}

double openSky(const GaussianCloud& c, vec3 x, vec3 n) {
  const auto tracer = makeCpuDevice()->newTracer({}, c);
  std::vector<Ray> rays;
  const Frame3 frame(n);
  for (std::uint32_t i = 0; i < 4096; ++i)
    rays.push_back({x, frame.toWorld(cosineDirection(R2Sequence{7, 9}(i)))});
  std::vector<std::uint8_t> b(rays.size());
  tracer->occluded(rays, b);
  return 1 - static_cast<double>(std::count(b.begin(), b.end(), 1)) / static_cast<double>(rays.size());
}

TEST(AmbientOcclusion, OfAnOpenPlaneIsOne) { EXPECT_EQ(openSky({}, {0, 0, 0}, {0, 1, 0}), 1); }

TEST(AmbientOcclusion, BesideAWallIsTheClosedForm) {
  GaussianCloud c;
  addWall(c, 0.3f, 0.5f);
  const double d = 0.3, h = 0.5;
  EXPECT_NEAR(openSky(c, {0, 0, 0}, {0, 1, 0}), (1 + d / std::sqrt(d * d + h * h)) / 2, 0.03);
}

TEST(AmbientOcclusion, UnderASphereIsTheClosedForm) {
  GaussianCloud c;
  const float radius = 0.25f, height = 0.6f;
  constexpr int kCount = 4000;
  for (int i = 0; i < kCount; ++i) {
    const float z = 1 - (2 * i + 1.0f) / kCount, r = std::sqrt(1 - z * z),
                phi = 2.39996323f * static_cast<float>(i);
    const vec3 n(r * std::cos(phi), z, r * std::sin(phi));
    const vec3 axis = glm::cross(vec3(0, 0, 1), n);
    add(c, vec3(0, height, 0) + radius * n, glm::normalize(quat(1.0001f + n.z, axis.x, axis.y, axis.z)),
        {0.014f, 0.014f, 0.002f}, 0.95f);
  }
  const double ratio = radius / height;
  EXPECT_NEAR(openSky(c, {0, 0, 0}, {0, 1, 0}), 1 - ratio * ratio, 0.03);
}

}  // namespace
}  // namespace beam
