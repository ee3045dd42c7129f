// SPDX-License-Identifier: Apache-2.0
#include "core/math/sampling.h"

#include <gtest/gtest.h>

#include "core/base/rng.h"
#include "core/math/brdf.h"

namespace beam {
namespace {

vec3 randomDirection(const RandomStream& random, std::uint64_t i) {
  return glm::normalize(vec3(random.normal(3 * i), random.normal(3 * i + 1), random.normal(3 * i + 2)));
}

TEST(Frame3, IsOrthonormalAroundEveryNormal) {
  const RandomStream random(1);
  for (int i = 0; i < 1000; ++i) {
    const vec3 n = i == 0 ? vec3(0, 0, -1) : i == 1 ? vec3(0, 0, 1) : randomDirection(random, i);
    const Frame3 f(n);
    EXPECT_NEAR(glm::dot(f.tangent, f.bitangent), 0, 1e-5);
    EXPECT_NEAR(glm::dot(f.tangent, n), 0, 1e-5);
    EXPECT_NEAR(glm::length(f.tangent), 1, 1e-5);
    EXPECT_NEAR(glm::dot(glm::cross(f.tangent, f.bitangent), n), 1, 1e-5);
    EXPECT_NEAR(glm::length(f.toWorld(f.toLocal(vec3(1, 2, 3))) - vec3(1, 2, 3)), 0, 1e-5);
  }
}

TEST(R2Sequence, FillsBoxesMoreEvenlyThanChance) {
  const R2Sequence sequence{0x12345678u, 0x9abcdef0u};
  for (const std::uint32_t start : {0u, 1000u, 4000000000u}) {
    int boxes[4][4] = {};
    for (std::uint32_t i = 0; i < 160; ++i) {
      const vec2 u = sequence(start + i);
      ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
      ++boxes[static_cast<int>(u.x * 4)][static_cast<int>(u.y * 4)];
    }
    for (const auto& row : boxes) {
      for (const int count : row) EXPECT_NEAR(count, 10, 4);  // chance: 3.1 standard deviation
    }
  }
}

TEST(CosineDirection, HasTheMomentsOfACosine) {
  dvec3 sum(0);
  double square = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const vec3 d = cosineDirection(R2Sequence{}(i));
    ASSERT_NEAR(glm::length(d), 1, 1e-5);
    sum += dvec3(d);
    square += d.z * d.z;
  }
  EXPECT_NEAR(sum.x / n, 0, 1e-3);
  EXPECT_NEAR(sum.y / n, 0, 1e-3);
  EXPECT_NEAR(sum.z / n, 2.0 / 3, 1e-3);
  EXPECT_NEAR(square / n, 0.5, 1e-3);
}

// The mean of 1 / pdf over the drawn directions is the solid angle that they cover; with g / pdf, the
// integral of g.
TEST(VisibleNormal, HasTheDensityThatTheBrdfStates) {
  for (const float roughness : {0.3f, 0.6f, 1.0f}) {
    for (const float cosine : {1.0f, 0.5f, 0.2f}) {
      const float alpha = ggxAlpha(roughness);
      const vec3 v(std::sqrt(1 - cosine * cosine), 0, cosine);
      const int n = 40000;
      double drawn = 0, integrated = 0;
      for (int i = 0; i < n; ++i) {
        const vec2 u = R2Sequence{}(i);
        const vec3 h = visibleNormal(v, alpha, u);
        const vec3 l = 2 * glm::dot(v, h) * h - v;
        if (l.z > 0) drawn += l.z * l.z / n;  // E[l.z^2]
        const vec3 d = cosineDirection(u);
        integrated += reflectance(vec3(0, 0, 1), d, v, alpha).reflection_pdf * d.z * kPi / n;
      }
      EXPECT_NEAR(drawn, integrated, 0.01) << "roughness " << roughness << " cosine " << cosine;
    }
  }
}

TEST(Reflectance, IsReciprocal) {
  const RandomStream random(7);
  for (int i = 0; i < 200; ++i) {
    vec3 a = randomDirection(random, 2 * i), b = randomDirection(random, 2 * i + 1);
    a.z = std::abs(a.z);
    b.z = std::abs(b.z);
    const float ab = reflectance({0, 0, 1}, a, b, 0.3f).specular,
                ba = reflectance({0, 0, 1}, b, a, 0.3f).specular;
    EXPECT_NEAR(ab, ba, 1e-4f * (1 + ab));
  }
}

TEST(Reflectance, IsNothingBelowTheHorizon) {
  EXPECT_EQ(reflectance({0, 0, 1}, {0, 0, -1}, {0, 0, 1}, 0.3f).specular, 0);
  EXPECT_EQ(reflectance({0, 0, 1}, glm::normalize(vec3(1, 0, -0.1f)), {0, 0, 1}, 0.3f).reflection_pdf, 0);
}

}  // namespace
}  // namespace beam
