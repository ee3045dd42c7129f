// SPDX-License-Identifier: Apache-2.0
#include "core/render/deferred.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/rng.h"
#include "core/math/brdf.h"
#include "core/math/color.h"
#include "core/math/sampling.h"
#include "core/render/prepared_light.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam {
namespace {

Environment uniformLight() { return makeEnvironment(Image<vec3>(32, 16, vec3(1))); }

Environment smoothLight() {
  Image<vec3> map(64, 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const vec3 d = directionFromLatLong({(x + 0.5f) / 64, (y + 0.5f) / 32});
      map(x, y) = 1.0f + 0.5f * vec3(d.x, d.y, d.z);
    }
  }
  return makeEnvironment(std::move(map));
}

Environment sun(vec3 direction) {
  Image<vec3> map(128, 64, vec3(0.2f));
  const vec2 uv = latLongFromDirection(direction);
  map(static_cast<int>(uv.x * 128), static_cast<int>(uv.y * 64)) = vec3(750);
  return makeEnvironment(std::move(map));
}

vec3 direction(std::uint64_t i) {
  const RandomStream r(9);
  return glm::normalize(vec3(r.normal(3 * i), r.normal(3 * i + 1), r.normal(3 * i + 2)));
}

vec3 irradianceByQuadrature(const Environment& e, vec3 n) {
  dvec3 sum(0);
  const int w = e.radiance.width, h = e.radiance.height;
  for (int y = 0; y < h; ++y) {
    const double solid = 2 * kPi / w * (std::cos(kPi * y / h) - std::cos(kPi * (y + 1) / h));
    for (int x = 0; x < w; ++x) {
      const vec3 d = directionFromLatLong({(x + 0.5f) / w, (y + 0.5f) / h});
      sum += dvec3(e.radiance(x, y)) * (solid * std::max(0.0f, glm::dot(d, n)));
    }
  }
  return vec3(sum);
}

TEST(PreparedLight, GivesPiEverywhereUnderAUniformSky) {
  const PreparedLight light = prepareLight(uniformLight());
  for (int i = 0; i < 50; ++i) {
    EXPECT_NEAR(irradiance(light, direction(i)).y, kPi, 0.01);
    for (const float r : {0.0f, 0.13f, 0.5f, 1.0f})
      EXPECT_NEAR(prefiltered(light, direction(i), r).y, 1, 1e-3);
  }
}

TEST(PreparedLight, IntegratesSmoothAndSunLikePanoramasAlike) {
  for (const Environment& e : {smoothLight(), sun(glm::normalize(vec3(1, 2, -1)))}) {
    const PreparedLight light = prepareLight(e);
    float brightest = 0;
    for (int i = 0; i < 200; ++i) brightest = std::max(brightest, irradianceByQuadrature(e, direction(i)).y);
    for (int i = 0; i < 200; ++i) {
      const float expected = irradianceByQuadrature(e, direction(i)).y;
      EXPECT_NEAR(irradiance(light, direction(i)).y, expected, 0.01f * brightest);
    }
  }
}

// A round lamp, so that sampling finds it.
Environment lamp(vec3 center) {
  Image<vec3> map(128, 64, vec3(0.2f));
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x) {
      const float c = glm::dot(center, directionFromLatLong({(x + 0.5f) / 128, (y + 0.5f) / 64}));
      map(x, y) += vec3(20 * std::exp(200 * (c - 1)));
    }
  }
  return makeEnvironment(std::move(map));
}

// The lobe of n = v = r by sampling: sum of L (n.l) / sum of (n.l) over half vectors with density D (n.h).
TEST(PreparedLight, PrefiltersWithTheLobeOfTheBrdf) {
  const Environment e = lamp(glm::normalize(vec3(1, 1, 0)));
  const PreparedLight light = prepareLight(e);
  for (const float roughness : {0.1f, 0.2f, 0.3f, 0.6f, 0.9f}) {
    for (const float angle : {0.0f, 0.3f, 0.8f}) {
      const float at = kPi / 4 - angle;
      const vec3 n(std::cos(at), std::sin(at), 0);
      const Frame3 frame(n);
      double sum = 0, weight = 0;
      for (std::uint32_t i = 0; i < 100000; ++i) {
        const vec3 h = visibleNormal({0, 0, 1}, ggxAlpha(roughness), R2Sequence{}(i));
        const vec3 l = 2 * h.z * h - vec3(0, 0, 1);
        if (l.z <= 0) continue;
        sum += radianceFrom(e, frame.toWorld(l)).y * l.z;
        weight += l.z;
      }
      EXPECT_NEAR(prefiltered(light, n, roughness).y, sum / weight, 0.04 * sum / weight)
          << roughness << " " << angle;
    }
  }
}

TEST(PreparedLight, TurnsWithTheYawAsThePanoramaDoes) {
  const Environment e = sun(glm::normalize(vec3(0.2f, 0.5f, 1)));
  Environment turned_environment = e;
  turned_environment.yaw_rad = 1.1f;
  const PreparedLight light = prepareLight(e), turned_light = prepareLight(turned_environment);
  const LightTurn turn(light, 1.1f), turn_of_own(turned_light, 0);
  for (int i = 0; i < 50; ++i) {
    const vec3 d = direction(i), in_light = turn(d), in_turned = turn_of_own(d);
    EXPECT_NEAR(irradiance(light, in_light).y, irradiance(turned_light, in_turned).y, 1e-3);
    EXPECT_NEAR(lookUp(light.radiance, in_light).y, radianceFrom(turned_environment, d).y, 0.02 * 750);
    EXPECT_NEAR(prefiltered(light, in_light, 0.5f).y, prefiltered(turned_light, in_turned, 0.5f).y, 1e-3);
  }
  // Positive yaw moves the light from +Z towards +X.
  const auto fromTheSide = [&](float yaw) { return irradiance(light, LightTurn(light, yaw)({1, 0, 0})).y; };
  EXPECT_GT(fromTheSide(kPi / 2), 2 * fromTheSide(-kPi / 2));
}

TEST(SplitSum, GivesTheFurnaceValuesOfTheSameBrdf) {
  struct Row {
    float roughness;
    double specular[4];
  };
  for (const Row& row : {Row{0.2f, {.0399, .0400, .0708, .3666}}, Row{0.5f, {.0367, .0367, .0557, .1382}},
                         Row{0.8f, {.0223, .0230, .0314, .0614}}, Row{1.0f, {.0123, .0136, .0209, .0422}}}) {
    constexpr float kAngles[4] = {0, 30, 60, 80};
    for (int a = 0; a < 4; ++a) {
      const vec2 ab = splitSum(std::cos(kAngles[a] * kPi / 180), row.roughness);
      EXPECT_NEAR(kF0 * ab.x + ab.y, row.specular[a], 0.02 * row.specular[a] + 2e-4)
          << row.roughness << " " << a;
    }
  }
}

Camera frontCamera(int size = 32) { return testing::cameraLookingAt({0, 0, 2}, {0, 0, 0}, size, size); }

// A G-buffer of one material, seen head-on everywhere.
GBuffer flat(const Camera& camera, float alpha, vec3 rho, float occlusion, float roughness) {
  const int w = camera.width, h = camera.height;
  return {.alpha = Image<float>(w, h, alpha),
          .depth_m = Image<float>(w, h, 2),
          .normal_world = Image<vec3>(w, h, vec3(0, 0, 1)),
          .radiance = Image<vec3>(w, h),
          .base_color = Image<vec3>(w, h, alpha * rho),
          .ambient_occlusion = Image<float>(w, h, alpha * occlusion),
          .roughness = Image<float>(w, h, alpha * roughness)};
}

TEST(Shade, KeepsTheFurnace) {
  const Camera camera = frontCamera();
  const PreparedLight light = prepareLight(uniformLight());
  for (const float roughness : {0.3f, 0.6f, 0.9f}) {
    for (const float rho : {0.0f, 0.2f, 0.8f}) {
      const Image<vec3> out = shade(flat(camera, 1, vec3(rho), 1, roughness), camera, light, {});
      const vec2 ab = splitSum(1, roughness);
      const float expected = 0.955f * rho + kF0 * ab.x + ab.y;
      EXPECT_NEAR(out(16, 16).y, expected, 0.02 * expected);
    }
  }
}

TEST(Shade, IsPremultipliedAndBlackOutside) {
  const Camera camera = frontCamera();
  const PreparedLight light = prepareLight(smoothLight());
  GBuffer half = flat(camera, 0.5f, vec3(0.4f), 0.7f, 0.5f);
  half.alpha(3, 3) = 0;
  const Image<vec3> full = shade(flat(camera, 1, vec3(0.4f), 0.7f, 0.5f), camera, light, {});
  const Image<vec3> out = shade(half, camera, light, {});
  EXPECT_NEAR(out(10, 10).x, 0.5f * full(10, 10).x, 1e-6);
  EXPECT_EQ(out(3, 3), vec3(0));
}

TEST(Shade, DarkensWithOcclusionAndLessSoWhereColorBounces) {
  const Camera camera = frontCamera();
  const PreparedLight light = prepareLight(uniformLight());
  const auto value = [&](float occlusion, ShadeOptions o) {
    return shade(flat(camera, 1, vec3(0.8f), occlusion, 0.9f), camera, light, o)(16, 16).y;
  };
  const float open = value(1, {}), plain = value(0.5f, {.multibounce_ao = false}), coloured = value(0.5f, {});
  EXPECT_LT(plain, coloured);
  EXPECT_LT(coloured, open);
  EXPECT_NEAR(plain / open, 0.5, 0.03);
  EXPECT_LT(value(0, {.multibounce_ao = false}), 1e-3);
  EXPECT_GT(value(0, {.multibounce_ao = false, .specular_occlusion = false}), 0.01);
}

TEST(Shade, ScalesWithExposure) {
  const Camera camera = frontCamera();
  const PreparedLight light = prepareLight(uniformLight());
  const GBuffer g = flat(camera, 1, vec3(0.5f), 1, 0.5f);
  EXPECT_NEAR(shade(g, camera, light, {.exposure = 2})(8, 8).x, 2 * shade(g, camera, light, {})(8, 8).x,
              1e-5);
}

TEST(Shade, RefusesAGBufferWithoutMaterials) {
  const Camera camera = frontCamera();
  GBuffer g = flat(camera, 1, vec3(0.5f), 1, 0.5f);
  g.base_color = {};
  EXPECT_THROW(shade(g, camera, prepareLight(uniformLight()), {}), Error);
}

Materials constantMaterials(std::size_t count, vec3 rho, float occlusion, float roughness) {
  Materials m{std::vector<float>(count, roughness), ShBlock(count, 3), ShBlock(count, 1)};
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) m.base_color.of(i)[c] = (rho[c] - 0.5f) / kShC0;
    m.ambient_occlusion.of(i)[0] = (occlusion - 0.5f) / kShC0;
  }
  return m;
}

class SphereGBuffer : public ::testing::Test {
 protected:
  SphereGBuffer() {
    testing_camera = testing::cameraLookingAt({0.2, 0.3, 2}, {0, 0, 0}, 64, 90);
    testing::addSphere(cloud, vec3(0), 0.4f, 4000);
  }
  std::unique_ptr<ComputeDevice> device = makeCpuDevice();
  GaussianCloud cloud;
  Camera testing_camera;
};

TEST_F(SphereGBuffer, HoldsTheSphere) {
  const vec3 rho(0.2f, 0.5f, 0.7f);
  const Materials materials = constantMaterials(cloud.size(), rho, 0.6f, 0.35f);
  const GBuffer g = GBufferRenderer(*device).render(*residentOf(*device, cloud, &materials), testing_camera);
  const Rigid3 world_from_camera = inverse(testing_camera.camera_from_world);
  int inside = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float alpha = g.alpha(x, y);
      if (alpha < 1 / 255.0f) {
        EXPECT_EQ(g.normal_world(x, y), vec3(0));
      }
      if (alpha < 0.5f) {
        EXPECT_EQ(g.depth_m(x, y), 0);
      }
      const dvec3 ray = rayOf(testing_camera.intrinsics, {x + 0.5, y + 0.5});
      const dvec3 o = world_from_camera.translation_m, d = glm::normalize(world_from_camera.rotation * ray);
      const double b = glm::dot(o, d), c = glm::dot(o, o) - 0.36 * 0.36;  // away from the rim
      if (b * b < c) continue;
      ++inside;
      const double t = -b - std::sqrt(b * b - glm::dot(o, o) + 0.16);
      const vec3 n(glm::normalize(o + t * d));
      EXPECT_GT(alpha, 0.95f);
      EXPECT_NEAR(g.depth_m(x, y), t / glm::length(ray), 0.015);
      EXPECT_GT(glm::dot(g.normal_world(x, y), n), 0.99f);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(g.base_color(x, y)[k], alpha * rho[k], 2e-3);
      EXPECT_NEAR(g.ambient_occlusion(x, y), alpha * 0.6f, 2e-3);
      EXPECT_NEAR(g.roughness(x, y), alpha * 0.35f, 2e-3);
    }
  }
  EXPECT_GT(inside, 300);
}

TEST_F(SphereGBuffer, LeavesMaterialsEmptyWhenThereAreNone) {
  const GBuffer g = GBufferRenderer(*device).render(*residentOf(*device, cloud, nullptr), testing_camera);
  EXPECT_TRUE(g.base_color.empty() && g.ambient_occlusion.empty() && g.roughness.empty());
  EXPECT_FALSE(g.alpha.empty() || g.radiance.empty());
}

TEST_F(SphereGBuffer, ClampsAfterBlending) {
  const Materials materials = constantMaterials(cloud.size(), vec3(1.4f, -0.3f, 0.5f), 1.2f, 0.5f);
  const GBuffer g = GBufferRenderer(*device).render(*residentOf(*device, cloud, &materials), testing_camera);
  EXPECT_EQ(g.base_color(32, 32).x, 1);
  EXPECT_EQ(g.base_color(32, 32).y, 0);
  EXPECT_EQ(g.ambient_occlusion(32, 32), 1);
}

TEST_F(SphereGBuffer, IsBrightestWhereTheSunStands) {
  const Materials materials = constantMaterials(cloud.size(), vec3(0.5f), 1, 0.9f);
  const GBuffer g = GBufferRenderer(*device).render(*residentOf(*device, cloud, &materials), testing_camera);
  const PreparedLight light = prepareLight(sun(glm::normalize(vec3(1, 0, 1))));
  const auto brightestAt = [&](float yaw) {
    const Image<vec3> out = shade(g, testing_camera, light, {.yaw_rad = yaw});
    const auto best =
        std::max_element(out.pixels.begin(), out.pixels.end(), [](vec3 a, vec3 b) { return a.y < b.y; });
    return g.normal_world.pixels[static_cast<std::size_t>(best - out.pixels.begin())];
  };
  EXPECT_GT(brightestAt(0).x, 0.4f);
  EXPECT_LT(brightestAt(-kPi / 2).x, -0.4f);
}

}  // namespace
}  // namespace beam
