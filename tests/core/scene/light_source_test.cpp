// SPDX-License-Identifier: Apache-2.0
// The one falloff: closed forms of distance, window, cone and flat lamps, and what is at their ends.
#include "core/scene/light_source.h"

#include <gtest/gtest.h>

#include <cmath>

namespace beam {
namespace {

template <class Kind>
Light lightOf(const Kind& kind) {
  Light light;
  light.id = "key";
  light.kind = kind;
  return light;
}

float arriving(const LightSource& source, vec3 x) { return arrivingAt(source, x).irradiance.x; }

TEST(LightSource, OfASunIsTheSameEverywhere) {
  const auto sources =
      sourcesOf(lightOf(DirectionalLight{.azimuth_deg = 90, .elevation_deg = 0, .intensity = 2}));
  ASSERT_EQ(sources.size(), 1u);
  for (const vec3& x : {vec3(0), vec3(7, -3, 2)}) {
    const ArrivingLight a = arrivingAt(sources[0], x);
    EXPECT_NEAR(glm::length(a.toward - vec3(1, 0, 0)), 0, 1e-6f);
    EXPECT_FLOAT_EQ(a.irradiance.x, 2);
    EXPECT_TRUE(std::isinf(a.distance_m));
  }
}

TEST(LightSource, FallsOffWithTheSquareOfTheDistanceAndInItsWindow) {
  PointLight lamp{.position_m = dvec3(0, 1, 0), .intensity = 8};
  EXPECT_FLOAT_EQ(arriving(sourcesOf(lightOf(lamp))[0], {0, 3, 0}), 2);
  EXPECT_FLOAT_EQ(arriving(sourcesOf(lightOf(lamp))[0], {0, 1, -4}), 0.5f);
  lamp.range_m = 4;
  const LightSource source = sourcesOf(lightOf(lamp))[0];
  EXPECT_FLOAT_EQ(arriving(source, {0, 3, 0}), 2 * std::pow(1 - std::pow(0.5f, 4.0f), 2.0f));
  EXPECT_EQ(arriving(source, {0, 5, 0}), 0);
  EXPECT_EQ(arriving(source, {0, 9, 0}), 0);
}

TEST(LightSource, OfASpotIsWholeInsideAndNothingOutside) {
  SpotLight spot{
      .position_m = dvec3(0), .target_m = dvec3(0, 0, 1), .inner_deg = 20, .outer_deg = 40, .intensity = 1};
  const LightSource source = sourcesOf(lightOf(spot))[0];
  const auto at = [&](double degrees) {
    const auto a = static_cast<float>(degrees * kPi / 180);
    return arriving(source, {std::sin(a), 0, std::cos(a)});
  };
  EXPECT_FLOAT_EQ(at(0), 1);
  EXPECT_FLOAT_EQ(at(19.9), 1);
  EXPECT_NEAR(at(30), 0.25, 1e-4);  // smoothstep of one half, squared
  EXPECT_EQ(at(40.1), 0);
  EXPECT_EQ(at(180), 0);
}

TEST(LightSource, HasNoNumberThatIsNoneHoweverItsConeStands) {
  for (const double outer : {0.0, 1e-6, 30.0, 60.0, 90.0}) {
    for (const double inner : {0.0, outer, 90.0}) {
      const SpotLight spot{.position_m = dvec3(0),
                           .target_m = dvec3(0, 0, 1),
                           .inner_deg = inner,
                           .outer_deg = outer,
                           .intensity = 1};
      const LightSource source = sourcesOf(lightOf(spot))[0];
      for (const vec3& x :
           {vec3(0), vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), vec3(1, 0, 1), vec3(1e-20f)})
        EXPECT_TRUE(std::isfinite(arriving(source, x))) << outer << " " << inner << " " << x.x << " " << x.z;
      EXPECT_EQ(arriving(source, {0, 0, -1}), 0);
      EXPECT_EQ(arriving(source, {0, 0, 1}), outer > 0 ? 1 : 0) << outer << " " << inner;
    }
  }
  const PointLight lamp{.position_m = dvec3(0), .intensity = 1};
  EXPECT_FLOAT_EQ(arriving(sourcesOf(lightOf(lamp))[0], vec3(0)), 1 / (kNearestLight_m * kNearestLight_m));
}

// E on the axis of a disc-like rectangle from afar is L A / d^2, near it 4 L atan-terms of the closed form.
TEST(LightSource, OfARectangleAddsUpToItsRadiance) {
  const RectangleLight box{
      .position_m = dvec3(0, 2, 0), .target_m = dvec3(0), .width_m = 0.6, .height_m = 0.4, .intensity = 5};
  const auto sources = sourcesOf(lightOf(box));
  ASSERT_EQ(sources.size(), static_cast<std::size_t>(kRectanglePoints));
  const auto sum = [&](vec3 x, vec3 n) {
    float e = 0;
    for (const LightSource& s : sources) {
      const ArrivingLight a = arrivingAt(s, x);
      e += a.irradiance.x * std::max(0.0f, glm::dot(n, a.toward));
    }
    return e;
  };
  vec3 middle(0);
  for (const LightSource& s : sources) middle += s.position_m / static_cast<float>(sources.size());
  EXPECT_NEAR(glm::length(middle - vec3(0, 2, 0)), 0, 1e-6f);
  // A parallel element under the middle: four corners' form factors.
  const auto closed = [&](double d) {
    const double a = 0.3 / d, b = 0.2 / d, ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
    return 5.0 * 2 * (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb));
  };
  EXPECT_NEAR(sum(vec3(0), {0, 1, 0}), closed(2), 0.01 * closed(2));
  EXPECT_NEAR(sum({0, 1.4f, 0}, {0, 1, 0}), closed(0.6), 0.04 * closed(0.6));
  EXPECT_EQ(sum({0, 3, 0}, {0, -1, 0}), 0);  // behind it
  for (const LightSource& s : sources)       // no surface is lit more than by a sky of its radiance
    EXPECT_LE(arriving(s, s.position_m - vec3(0, 1e-3f, 0)), 5 * kPi);
}

}  // namespace
}  // namespace beam
