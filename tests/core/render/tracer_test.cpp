// SPDX-License-Identifier: Apache-2.0
// Visibility: the cases of methods 11.3, closed forms of methods 11.2 on occluders of overlapping splats,
// independence of order, brute-force loops, and one occluded set from every tracer and instruction set.
#include "core/render/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/math/sampling.h"
#include "core/render/cpu/embree_tracer.h"
#include "core/render/cpu/splat_bvh.h"
#include "core/render/device.h"
#include "core/render/kernels/response.h"
#include "tests/support/capsule_man.h"

namespace beam {
namespace {

void add(GaussianCloud& c, vec3 x, quat q, vec3 s, float o) {
  c.position_m.push_back(x);
  c.rotation.push_back(q);
  c.scale_m.push_back(s);
  c.opacity.push_back(o);
  c.color.coefficients.resize(c.size() * kShCount * 3, 0.0f);
}

using Make = std::unique_ptr<Tracer> (*)(const TracerDesc&, const GaussianCloud&);

class Visibility : public ::testing::TestWithParam<Make> {
 protected:
  bool blocked(const GaussianCloud& c, const Ray& ray, TracerDesc desc = {}) const {
    const auto tracer = GetParam()(desc, c);
    std::uint8_t b = 0;
    tracer->occluded(std::span(&ray, 1), std::span(&b, 1));
    return b != 0;
  }
};
INSTANTIATE_TEST_SUITE_P(EveryTracer, Visibility, ::testing::Values(&makeEmbreeTracer, &makeSplatBvhTracer),
                         [](const auto& i) { return i.index == 0 ? "Embree" : "SplatBvh"; });

const Ray kAlongX{{-1, 0, 0}, {1, 0, 0}};

TEST_P(Visibility, OneSplatNeverBlocks) {
  GaussianCloud c;
  add(c, {0, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.99f);
  EXPECT_FALSE(blocked(c, kAlongX));
}

TEST_P(Visibility, TwoAtSixTenthsBlock) {
  GaussianCloud c;
  add(c, {0, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.6f);
  add(c, {0.3f, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.6f);
  EXPECT_TRUE(blocked(c, kAlongX));
}

TEST_P(Visibility, WhatLiesBehindTheOriginDoesNotCount) {
  GaussianCloud c;
  for (const float x : {-2.0f, -2.3f}) add(c, {x, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.9f);
  EXPECT_FALSE(blocked(c, kAlongX));
}

TEST_P(Visibility, SplatsThatHoldTheOriginAreIgnoredUnlessAskedFor) {
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

TEST_P(Visibility, SumsWhatTheBruteForceLoopInDoubleSums) {
  const GaussianCloud c = randomCloud(400);
  const auto tracer = GetParam()({}, c);
  int differ = 0;
  for (int i = 0; i < 600; ++i) {
    const double got = static_cast<double>(tracer->alphaSum(randomRay(i))) / scalar::kAlphaUnits;
    differ += std::abs(got - slowSum(c, randomRay(i), {})) > 1e-4;  // the cut fell on the other side
  }
  EXPECT_LE(differ, 1);
}

// What blending makes of a ray, in double, front to back.
struct Blend {
  double transmittance = 1;
  std::vector<double> weight;  // of each Gaussian
};

Blend slowBlend(const GaussianCloud& c, const Ray& ray, const TracerDesc& desc, double reach) {
  struct Hit {
    double at, alpha;
    std::size_t i;
  };
  std::vector<Hit> hits;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const dmat3 m = glm::transpose(glm::mat3_cast(dquat(c.rotation[i])));
    const dvec3 s(c.scale_m[i]), o = m * (dvec3(ray.origin) - dvec3(c.position_m[i])) / s,
                                 d = m * dvec3(ray.direction) / s;
    const double cut2 = 2 * std::log(c.opacity[i] / desc.cut_response), at = -glm::dot(o, d) / glm::dot(d, d);
    const dvec3 across = glm::cross(o, d);
    const double r2 = glm::dot(across, across) / glm::dot(d, d);
    if (at <= 0 || at >= reach || r2 >= cut2 || glm::dot(o, o) < cut2) continue;
    hits.push_back({at, std::min(0.99, c.opacity[i] * std::exp(-0.5 * r2)), i});
  }
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.at < b.at; });
  Blend blend{1, std::vector<double>(c.size(), 0.0)};
  for (const Hit& h : hits) {
    blend.weight[h.i] = blend.transmittance * h.alpha;
    blend.transmittance *= 1 - h.alpha;
  }
  return blend;
}

TEST_P(Visibility, LetsThroughWhatBlendingLetsThrough) {
  const GaussianCloud c = randomCloud(400);
  const auto tracer = GetParam()({}, c);
  int differ = 0, dark = 0;
  for (int i = 0; i < 600; ++i) {
    const float reach = i % 2 ? kEndless_m : 1.0f;
    const double expected = slowBlend(c, randomRay(i), {}, reach).transmittance;
    const double got = tracer->transmittance(randomRay(i), {.reach_m = reach});
    differ += std::abs(got - (expected < 1.0 / 1024 ? 0 : expected)) > 1e-4;
    dark += expected < 0.5;
  }
  EXPECT_LE(differ, 2);
  EXPECT_GT(dark, 30);
}

TEST_P(Visibility, RaysEndInEachGaussianAsOftenAsItsBlendWeight) {
  const GaussianCloud c = randomCloud(60);
  const auto tracer = GetParam()({}, c);
  constexpr int kDraws = 20000;
  for (int r = 0; r < 8; ++r) {
    const Ray ray = randomRay(r);
    const Blend expected = slowBlend(c, ray, {}, 1e9);
    std::vector<int> ended(c.size());
    int through = 0;
    for (int k = 0; k < kDraws; ++k) {
      const std::optional<SplatHit> hit = tracer->drawn(ray, RandomStream(17, r).bits(k));
      hit ? ++ended[hit->splat] : ++through;
    }
    EXPECT_NEAR(through / double{kDraws}, expected.transmittance, 0.015) << r;
    for (std::size_t i = 0; i < c.size(); ++i)
      EXPECT_NEAR(ended[i] / double{kDraws}, expected.weight[i], 0.015) << r << " " << i;
  }
}

TEST(Tracers, AllGiveTheSameBlends) {
  const GaussianCloud c = randomCloud(3000);
  const auto own = makeSplatBvhTracer({}, c), embree = makeEmbreeTracer({}, c);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray = randomRay(i);
    EXPECT_EQ(own->transmittance(ray), embree->transmittance(ray)) << i;
    const std::uint64_t chance = RandomStream(5).bits(i);
    const auto a = own->drawn(ray, chance), b = embree->drawn(ray, chance);
    ASSERT_EQ(a.has_value(), b.has_value()) << i;
    if (!a) continue;
    ++hits;
    EXPECT_EQ(a->splat, b->splat) << i;
    EXPECT_EQ(a->distance_m, b->distance_m) << i;
  }
  EXPECT_GT(hits, 500);
}

// The same formulas on every Gaussian, without a tree.
std::uint64_t sumWithoutTree(const std::vector<RaySplat>& splats, const Ray& ray, bool ignore_containing) {
  const scalar::RayLine<float> line = {{ray.origin.x, ray.origin.y, ray.origin.z},
                                       {ray.direction.x, ray.direction.y, ray.direction.z}};
  std::uint64_t sum = 0;
  for (const RaySplat& s : splats) {
    const float* m = s.canonical;
    const scalar::RayTarget<float> target = {{{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}}},
                                             {s.center.x, s.center.y, s.center.z},
                                             s.opacity,
                                             s.cut2};
    const auto e = scalar::encounter(target, line);
    if (!scalar::meets(target, e) || !scalar::isAhead(e)) continue;
    if (ignore_containing && scalar::holdsOrigin(target, line)) continue;
    sum += static_cast<std::uint64_t>(scalar::alphaUnits(target, e));
  }
  return sum;
}

TEST_P(Visibility, MissesNoGaussianOfTheTree) {
  const GaussianCloud c = randomCloud(3000);
  for (const bool ignore_containing : {true, false}) {
    const TracerDesc desc{.ignore_containing = ignore_containing};
    const auto tracer = GetParam()(desc, c);
    const auto splats = raySplats(desc, c);
    for (int i = 0; i < 300; ++i) {
      Ray ray = randomRay(i);
      if (i % 5 == 1) ray.direction = {0, i % 2 ? 1 : -1, 0};
      if (i % 5 == 2) ray.direction = glm::normalize(vec3(ray.direction.x, 0, ray.direction.z));
      if (i % 5 == 3) ray.origin *= 20.0f;
      if (i % 5 == 3) ray.direction = glm::normalize(0.3f * ray.direction - glm::normalize(ray.origin));
      EXPECT_EQ(tracer->alphaSum(ray), sumWithoutTree(splats, ray, ignore_containing)) << i;
    }
  }
}

TEST_P(Visibility, DoesNotDependOnTheOrderOfTheSplats) {
  const GaussianCloud c = randomCloud(400);
  GaussianCloud reversed;
  for (std::size_t i = c.size(); i-- > 0;)
    add(reversed, c.position_m[i], c.rotation[i], c.scale_m[i], c.opacity[i]);
  const auto a = GetParam()({}, c), b = GetParam()({}, reversed);
  for (int i = 0; i < 300; ++i) EXPECT_EQ(a->alphaSum(randomRay(i)), b->alphaSum(randomRay(i)));
}

TEST_P(Visibility, BlocksOnlyAboveTheThreshold) {
  GaussianCloud c;
  add(c, {0, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.5f);
  EXPECT_FALSE(blocked(c, kAlongX, {.threshold = 0.5f}));
  EXPECT_TRUE(blocked(c, kAlongX, {.threshold = 0.4999f}));
}

TEST_P(Visibility, IsFreeWithoutGaussians) {
  GaussianCloud faint;
  add(faint, {0, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.01f);  // below the cut
  EXPECT_FALSE(blocked({}, kAlongX, {.threshold = 0}));
  EXPECT_FALSE(blocked(faint, kAlongX, {.threshold = 0}));
  GetParam()({}, faint)->occluded({}, {});
}

TEST_P(Visibility, CountsEveryOneOfManyGaussiansInOnePlace) {
  GaussianCloud c;
  for (int i = 0; i < 1000; ++i) add(c, {0, 0, 0}, {1, 0, 0, 0}, vec3(0.05f), 0.5f);
  EXPECT_EQ(GetParam()({}, c)->alphaSum(kAlongX), 1000u << 19);
}

std::vector<std::uint8_t> blockedRays(Make make, const GaussianCloud& cloud, std::span<const Ray> rays) {
  std::vector<std::uint8_t> blocked(rays.size());
  make({}, cloud)->occluded(rays, blocked);
  return blocked;
}

TEST(Tracers, OccludeTheSameRaysOfTheCapsuleMan) {
  const GaussianCloud man = testing::capsuleCloud(20000);
  const std::vector<Ray> rays = testing::capsuleRays(400, 50, 0.01f);
  const std::vector<std::uint8_t> expected = blockedRays(&makeEmbreeTracer, man, rays);
  const auto occluded = std::count(expected.begin(), expected.end(), 1);
  EXPECT_GT(occluded, 1000);
  EXPECT_LT(occluded, 5000);
  for (const SimdTarget t : {SimdTarget::Auto, SimdTarget::Avx512, SimdTarget::Avx2, SimdTarget::Scalar}) {
    try {
      makeCpuDevice(t);
    } catch (const std::exception& e) {
      std::cout << "skipped an instruction set: " << e.what() << "\n";
      continue;
    }
    EXPECT_EQ(blockedRays(&makeSplatBvhTracer, man, rays), expected) << static_cast<int>(t);
  }
  makeCpuDevice(SimdTarget::Auto);
}

TEST(Tracers, BuildTheSameTreeOnAnyNumberOfThreads) {
  const std::vector<RaySplat> splats = raySplats({}, testing::capsuleCloud(30000));
  setThreadCount(1);
  const SplatBvh one = buildSplatBvh(splats);
  setThreadCount(2);
  const SplatBvh two = buildSplatBvh(splats);
  setThreadCount(0);
  const auto same = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
  };
  EXPECT_TRUE(same(one.nodes, two.nodes));
  EXPECT_TRUE(same(one.blocks, two.blocks));
}

// The capsule man in a twist: the higher, the further turned.
GaussianCloud twisted(GaussianCloud cloud, float per_m) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const quat turn = glm::angleAxis(per_m * cloud.position_m[i].y, vec3(0, 1, 0));
    cloud.position_m[i] = turn * cloud.position_m[i];
    cloud.rotation[i] = turn * cloud.rotation[i];
  }
  return cloud;
}

TEST(Tracers, OccludeTheSameFromATreeThatFollowsTheGaussians) {
  const GaussianCloud man = testing::capsuleCloud(20000);
  const std::vector<Ray> rays = testing::capsuleRays(400, 50, 0.01f);
  std::shared_ptr<const SplatBvh> tree;
  makeFollowingTracer({}, man, tree);
  const std::vector<std::uint32_t> places = tree->splat;
  for (const float per_m : {0.05f, 0.2f}) {
    const GaussianCloud now = twisted(man, per_m);
    const auto following = makeFollowingTracer({}, now, tree);
    EXPECT_EQ(tree->splat, places) << per_m;
    const auto fresh = makeSplatBvhTracer({}, now);
    std::vector<std::uint8_t> blocked(rays.size());
    following->occluded(rays, blocked);
    EXPECT_EQ(blocked, blockedRays(&makeSplatBvhTracer, now, rays)) << per_m;
    for (std::size_t i = 0; i < rays.size(); i += 97)
      EXPECT_EQ(following->alphaSum(rays[i]), fresh->alphaSum(rays[i])) << i;
  }
}

TEST(Tracers, BuildAnewWhereTheLastTreeDoesNotServe) {
  GaussianCloud c = randomCloud(3000);
  std::shared_ptr<const SplatBvh> tree;
  makeFollowingTracer({}, c, tree);
  const std::vector<std::uint32_t> places = tree->splat;
  std::reverse(c.position_m.begin(), c.position_m.end());  // as many, but others
  const auto other = makeFollowingTracer({}, c, tree);
  EXPECT_NE(tree->splat, places);
  EXPECT_EQ(costOf(*tree), tree->built_cost);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(other->alphaSum(randomRay(i)), makeSplatBvhTracer({}, c)->alphaSum(randomRay(i)));
  makeFollowingTracer({}, randomCloud(100), tree);
  EXPECT_EQ(tree->splats, 100u);
  makeFollowingTracer({}, {}, tree);
  EXPECT_EQ(makeFollowingTracer({}, randomCloud(50), tree)->alphaSum(randomRay(1)),
            makeSplatBvhTracer({}, randomCloud(50))->alphaSum(randomRay(1)));
}

// A sheet of overlapping splats with normal +X through (x, ., .), rows of y in [0, height], z in [-width,
// width].
void addWall(GaussianCloud& c, float x, float height, float width = 3, float spacing = 0.02f) {
  for (float y = spacing / 2; y < height; y += spacing) {
    for (float z = -width; z < width; z += spacing)
      add(c, {x, y, z}, {1, 0, 0, 0}, {0.002f, spacing, spacing}, 0.95f);
  }
}

void addDisc(GaussianCloud& c, vec3 center, vec3 normal, float sigma) {
  const vec3 axis = glm::cross(vec3(0, 0, 1), normal);
  add(c, center, glm::normalize(quat(1.0001f + normal.z, axis.x, axis.y, axis.z)), {sigma, sigma, 0.002f},
      0.95f);
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

TEST(AmbientOcclusion, OfAnOpenPlaneIsOne) {
  GaussianCloud ground;  // x and z in [-1, 1]
  for (float x = -1; x < 1; x += 0.02f) {
    for (float z = -1; z < 1; z += 0.02f) addDisc(ground, {x, 0, z}, {0, 1, 0}, 0.02f);
  }
  EXPECT_EQ(openSky({}, {0, 0, 0}, {0, 1, 0}), 1);
  EXPECT_GT(openSky(ground, {0, 0.01f, 0}, {0, 1, 0}), 0.995);  // 5 standard deviations off the sheet
}

TEST(AmbientOcclusion, AtTheFootOfAnEndlessWallIsOneHalf) {
  GaussianCloud c;
  addWall(c, 0.02f, 8, 8, 0.1f);
  EXPECT_NEAR(openSky(c, {0, 0, 0}, {0, 1, 0}), 0.5, 0.02);
}

TEST(AmbientOcclusion, BesideAWallIsTheClosedForm) {
  GaussianCloud c;
  addWall(c, 0.3f, 0.5f);
  const double d = 0.3, h = 0.5 + 0.02;  // the upper edge reaches about one standard deviation further
  EXPECT_NEAR(openSky(c, {0, 0, 0}, {0, 1, 0}), (1 + d / std::sqrt(d * d + h * h)) / 2, 0.015);
}

TEST(AmbientOcclusion, UnderASphereIsTheClosedForm) {
  GaussianCloud c;
  const float radius = 0.25f, height = 0.6f;
  constexpr int kCount = 4000;
  for (int i = 0; i < kCount; ++i) {
    const float z = 1 - (2 * i + 1.0f) / kCount, r = std::sqrt(1 - z * z),
                phi = 2.39996323f * static_cast<float>(i);
    const vec3 n(r * std::cos(phi), z, r * std::sin(phi));
    addDisc(c, vec3(0, height, 0) + radius * n, n, 0.014f);
  }
  const double ratio = radius / height;
  EXPECT_NEAR(openSky(c, {0, 0, 0}, {0, 1, 0}), 1 - ratio * ratio, 0.02);
}

// The origin sits in a ball of which a cap around the normal is left out.
TEST(AmbientOcclusion, InAnOpenConeIsTheSquareOfItsSine) {
  for (const double half_angle : {0.5, 0.9}) {
    GaussianCloud c;
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
      const float y = 1 - (2 * i + 1.0f) / kCount, r = std::sqrt(1 - y * y),
                  phi = 2.39996323f * static_cast<float>(i);
      if (std::acos(y) < half_angle + 0.02)
        continue;  // the rim reaches one standard deviation into the opening
      const vec3 n(r * std::cos(phi), y, r * std::sin(phi));
      addDisc(c, n, n, 0.025f);
    }
    EXPECT_NEAR(openSky(c, {0, 0, 0}, {0, 1, 0}), std::pow(std::sin(half_angle), 2), 0.02);
  }
}

}  // namespace
}  // namespace beam
