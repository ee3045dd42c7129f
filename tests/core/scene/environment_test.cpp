// SPDX-License-Identifier: Apache-2.0
// The panorama and what is made of it: directions, the table to draw from, irradiance.
#include "core/scene/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/rng.h"
#include "core/math/color.h"

namespace beam {
namespace {

constexpr int kWidth = 32, kHeight = 16;

vec3 randomDirection(std::uint64_t i) {
  const RandomStream r(4);
  return glm::normalize(vec3(r.normal(3 * i), r.normal(3 * i + 1), r.normal(3 * i + 2)));
}

// Every texel another colour; one is bright, one row is black.
Environment patchwork() {
  const RandomStream random(7);
  Image<vec3> map(kWidth, kHeight);
  for (std::size_t i = 0; i < map.pixels.size(); ++i)
    map.pixels[i] = vec3(random.uniform(3 * i), random.uniform(3 * i + 1), random.uniform(3 * i + 2));
  map(20, 5) = vec3(90, 80, 70);
  for (int x = 0; x < kWidth; ++x) map(x, 11) = vec3(0);
  return makeEnvironment(std::move(map));
}

vec3 centerOf(int x, int y) { return directionFromLatLong({(x + 0.5f) / kWidth, (y + 0.5f) / kHeight}); }

double solidAngle(int y) {
  const double pi = std::acos(-1.0);
  return 2 * pi / kWidth * (std::cos(pi * y / kHeight) - std::cos(pi * (y + 1) / kHeight));
}

vec3 turnedAboutY(vec3 d, float angle) { return glm::angleAxis(angle, vec3(0, 1, 0)) * d; }

TEST(LatLong, ComesBackFromDirections) {
  for (int i = 0; i < 500; ++i) {
    const vec3 d = randomDirection(i);
    const vec2 uv = latLongFromDirection(d);
    EXPECT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1);
    EXPECT_LT(glm::distance(directionFromLatLong(uv), d), 2e-3f * std::abs(d.y) + 1e-5f);
  }
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const vec2 uv = latLongFromDirection(centerOf(x, y));
      EXPECT_NEAR(uv.x * kWidth, x + 0.5, 1e-3);
      EXPECT_NEAR(uv.y * kHeight, y + 0.5, 1e-3);
    }
  }
}

TEST(LatLong, HasPlusYInTheTopRowPlusZInTheMiddleAndPlusXAtAQuarter) {
  EXPECT_EQ(latLongFromDirection({0, 1, 0}).y, 0);
  EXPECT_EQ(latLongFromDirection({0, -1, 0}).y, 1);
  EXPECT_EQ(latLongFromDirection({0, 0, 1}), vec2(0.5f, 0.5f));
  EXPECT_NEAR(latLongFromDirection({1, 0, 0}).x, 0.25, 1e-6);
  EXPECT_NEAR(latLongFromDirection({-1, 0, 0}).x, 0.75, 1e-6);
}

TEST(Environment, GivesTheTexelInItsMiddleAndAMeanBetween) {
  const Environment e = patchwork();
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      EXPECT_LT(glm::distance(radianceFrom(e, centerOf(x, y)), e.radiance(x, y)), 0.02f);
  }
  for (const int x : {0, 7, kWidth - 1}) {  // the last one across the seam, from both of its sides
    for (const float share : {0.25f, 0.75f}) {
      const vec3 between = directionFromLatLong({(x + 0.5f + share) / kWidth, 4.0f / kHeight});
      const int next = (x + 1) % kWidth;
      const vec3 mean =
          glm::mix(e.radiance(x, 3) + e.radiance(x, 4), e.radiance(next, 3) + e.radiance(next, 4), share);
      EXPECT_LT(glm::distance(2.0f * radianceFrom(e, between), mean), 1e-4f) << x << " " << share;
    }
  }
}

TEST(Environment, OfAPositiveYawMovesFromPlusZTowardsPlusX) {
  Image<vec3> map(kWidth, kHeight, vec3(0.1f));
  map(kWidth / 2, kHeight / 2) = vec3(9);
  Environment e = makeEnvironment(std::move(map));
  const vec3 straight = brightestDirection(e);
  EXPECT_GT(straight.z, 0.9f);
  e.yaw_rad = kPi / 2;
  EXPECT_GT(brightestDirection(e).x, 0.9f);
  for (const float yaw : {0.3f, 2.0f, -1.0f}) {
    e.yaw_rad = yaw;
    EXPECT_LT(glm::distance(brightestDirection(e), turnedAboutY(straight, yaw)), 1e-5f);
    EXPECT_NEAR(radianceFrom(e, brightestDirection(e)).x, 9, 0.05);
  }
}

TEST(Environment, SaysWhatItClearsButNotWhatFiltersLeave) {
  std::vector<std::string> said;
  const int sink = addLogSink([&](const LogRecord& r) { said.push_back(r.text); });
  Image<vec3> map(8, 4, vec3(1));
  map(2, 1).x = -9e-4f;
  const Environment ordinary = makeEnvironment(map);
  EXPECT_EQ(ordinary.radiance(2, 1), vec3(0, 1, 1));
  EXPECT_TRUE(said.empty());
  map(3, 1) = vec3(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -2);
  EXPECT_EQ(makeEnvironment(map).radiance(3, 1), vec3(0));
  removeLogSink(sink);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("2 values that are not finite and 1 below 0"), std::string::npos) << said[0];
}

TEST(Environment, IsMadeWithoutNegativeAndUnboundedTexels) {
  Image<vec3> map(2, 1, vec3(1, 2, 3));
  map(1, 0) = vec3(-1, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity());
  const Environment e = makeEnvironment(std::move(map));
  EXPECT_EQ(e.radiance(0, 0), vec3(1, 2, 3));
  EXPECT_EQ(e.radiance(1, 0), vec3(0));
  EXPECT_EQ(e.radiance.encoding, Encoding::Linear);
  EXPECT_THROW(makeEnvironment({}), Error);
}

TEST(Environment, MeanOfAConstantIsTheConstantAndGrowsWithTheGain) {
  Environment e = makeEnvironment(Image<vec3>(kWidth, kHeight, vec3(0.2f, 0.5f, 3)));
  EXPECT_LT(glm::distance(meanRadiance(e), vec3(0.2f, 0.5f, 3)), 1e-5f);
  e.gain = 4;
  EXPECT_LT(glm::distance(meanRadiance(e), vec3(0.8f, 2, 12)), 1e-4f);
  EXPECT_LT(glm::distance(radianceFrom(e, randomDirection(1)), vec3(0.8f, 2, 12)), 1e-4f);
}

TEST(Sampler, HasADensityThatIntegratesToOne) {
  for (const Environment& e : {patchwork(), makeEnvironment(Image<vec3>(kWidth, kHeight, vec3(0)))}) {
    const EnvironmentSampler sampler(e);
    double sum = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) sum += sampler.pdf(centerOf(x, y)) * solidAngle(y);
    }
    EXPECT_NEAR(sum, 1, 1e-5);
  }
}

TEST(Sampler, DrawsInProportionToLuminanceAndNeverWhereItIsBlack) {
  const Environment e = patchwork();
  const EnvironmentSampler sampler(e);
  const double total = luminance(meanRadiance(e)) * 4 * kPi;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      EXPECT_NEAR(sampler.pdf(centerOf(x, y)), luminance(e.radiance(x, y)) / total, 1e-6);
  }
  const RandomStream random(5);
  for (int i = 0; i < 5000; ++i) {
    const auto s = sampler.sample(random.uniform(2 * i), random.uniform(2 * i + 1));
    EXPECT_GT(s.pdf, 0);
    EXPECT_NEAR(glm::length(s.direction), 1, 1e-5);
  }
}

TEST(Sampler, SaysOfADirectionWhatItSaysWhenItDrawsIt) {
  Environment e = patchwork();
  e.yaw_rad = 0.7f;
  e.gain = 2;
  const EnvironmentSampler sampler(e);
  const RandomStream random(6);
  const int n = 20000;
  int different = 0;
  for (int i = 0; i < n; ++i) {
    const auto drawn = sampler.sample(random.uniform(2 * i), random.uniform(2 * i + 1));
    const auto told = sampler.at(drawn.direction);
    different += told.pdf != drawn.pdf || told.radiance != drawn.radiance;
    EXPECT_EQ(told.pdf, sampler.pdf(drawn.direction));
    EXPECT_EQ(told.radiance, sampler.texelRadiance(drawn.direction));
  }
  EXPECT_LT(different, n / 1000) << "only at the very borders of texels";
}

TEST(Sampler, GivesTheIntegralOfAnyFunction) {
  for (const float yaw : {0.0f, 1.1f}) {
    Environment e = patchwork();
    e.yaw_rad = yaw;
    const EnvironmentSampler sampler(e);
    const vec3 axis = randomDirection(3);
    const auto lobe = [&](vec3 d) { return std::max(0.0f, glm::dot(d, axis)); };
    double expected = 0, found = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x)
        expected += luminance(e.radiance(x, y)) * lobe(turnedAboutY(centerOf(x, y), yaw)) * solidAngle(y);
    }
    const int side = 200;  // strata
    for (int i = 0; i < side * side; ++i) {
      const auto s = sampler.sample((static_cast<float>(i % side) + 0.5f) / side,
                                    (static_cast<float>(i / side) + 0.5f) / side);
      found += luminance(s.radiance) * lobe(s.direction) / s.pdf / (side * side);
    }
    EXPECT_NEAR(found, expected, 0.01 * expected) << "yaw " << yaw;
  }
}

TEST(IrradianceSh, UnderAUniformSkyIsPiTimesItsRadianceEverywhere) {
  const auto sh = irradianceSh(makeEnvironment(Image<vec3>(64, 32, vec3(1, 0.5f, 2))));
  for (int i = 0; i < 100; ++i)
    EXPECT_LT(glm::distance(irradiance(sh, randomDirection(i)) / kPi, vec3(1, 0.5f, 2)), 5e-3f);
}

TEST(IrradianceSh, UnderALinearSkyIsTheClosedForm) {
  // L(w) = 1 + a.w: E(n) = pi + 2 pi / 3 a.n.
  const vec3 a(0.3f, -0.5f, 0.2f);
  Image<vec3> map(128, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x)
      map(x, y) = vec3(1 + glm::dot(a, directionFromLatLong({(x + 0.5f) / 128, (y + 0.5f) / 64})));
  }
  Environment e = makeEnvironment(std::move(map));
  for (const float yaw : {0.0f, 0.9f}) {
    e.yaw_rad = yaw;
    const auto sh = irradianceSh(e);
    for (int i = 0; i < 100; ++i) {
      const vec3 n = randomDirection(i);
      EXPECT_NEAR(irradiance(sh, n).x, kPi + 2 * kPi / 3 * glm::dot(turnedAboutY(a, yaw), n), 0.01);
    }
  }
}

TEST(IrradianceSh, IsNeverNegativeAndGrowsWithTheGain) {
  Image<vec3> map(64, 32, vec3(0));
  map(32, 3) = vec3(5000);  // a sun rings
  Environment e = makeEnvironment(std::move(map));
  const auto once = irradianceSh(e);
  e.gain = 3;
  const auto thrice = irradianceSh(e);
  for (int i = 0; i < 200; ++i) {
    const vec3 n = randomDirection(i);
    EXPECT_GE(irradiance(once, n).x, 0);
    EXPECT_NEAR(irradiance(thrice, n).x, 3 * irradiance(once, n).x, 1e-3f * irradiance(thrice, n).x);
  }
}

}  // namespace
}  // namespace beam
