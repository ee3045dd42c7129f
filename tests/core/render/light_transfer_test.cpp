// SPDX-License-Identifier: Apache-2.0
// Light past visibility: the tables against quadrature, the two limits of V, turns, and highlights.
#include "core/render/light_transfer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/rng.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/render/deferred.h"
#include "core/render/prepared_light.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam {
namespace {

constexpr float kOpen = 0.5f / kShC0;  // V = 1

vec3 direction(std::uint64_t i) {
  const RandomStream r(21);
  return glm::normalize(vec3(r.normal(3 * i), r.normal(3 * i + 1), r.normal(3 * i + 2)));
}

Visibility randomVisibility(std::uint64_t i) {
  const RandomStream r(22, i);
  Visibility v;
  for (int k = 0; k < kShCount; ++k) v[k] = 0.05f * r.normal(k);
  return v;
}

float valueOf(const Visibility& v, vec3 d) {
  const auto basis = shBasis(d);
  float sum = 0.5f;
  for (int k = 0; k < kShCount; ++k) sum += basis[k] * v[k];
  return sum;
}

// Brighter towards +X, with a lamp of a few degrees.
Environment lampedSky() {
  Image<vec3> map(128, 64, vec3(0), Encoding::Linear);
  const vec3 lamp = glm::normalize(vec3(-1, 1, 2));
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x) {
      const vec3 d = directionFromLatLong({(x + 0.5f) / 128, (y + 0.5f) / 64});
      map(x, y) = vec3(0.8f, 1.0f, 1.2f) * (1 + 0.8f * d.x) + (glm::dot(d, lamp) > 0.98f ? 9.0f : 0.0f);
    }
  }
  return makeEnvironment(std::move(map));
}

vec3 byQuadrature(const Environment& sky, vec3 n, const Visibility& v) {
  dvec3 sum(0);
  const int w = 128, h = 64;
  for (int y = 0; y < h; ++y) {
    const double angle = 2 * kPi / w * (std::cos(kPi * y / h) - std::cos(kPi * (y + 1) / h));
    for (int x = 0; x < w; ++x) {
      const vec3 d = directionFromLatLong({(x + 0.5f) / w, (y + 0.5f) / h});
      const double weight = angle * std::max(0.0f, glm::dot(d, n)) * static_cast<double>(valueOf(v, d));
      sum += weight * dvec3(sky.radiance(x, y));
    }
  }
  return vec3(sum);
}

TEST(LightTransfer, IsTheIntegralOfLightVisibilityAndCosine) {
  const Environment sky = lampedSky();
  const PreparedLight light = prepareLight(sky);
  for (std::uint64_t i = 0; i < 40; ++i) {
    const vec3 n = direction(i), open = irradiance(light, n);
    const Visibility v = randomVisibility(i);
    const vec3 got = seenIrradiance(light.transfer, n, v, open), truth = byQuadrature(sky, n, v);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], std::min(truth[c], open[c]), 0.02f * open[c]) << i;
  }
}

TEST(LightTransfer, IsAllOfItWhereAllIsSeenAndNothingWhereNothingIs) {
  const PreparedLight light = prepareLight(lampedSky());
  Visibility open{}, closed{};
  open[0] = kOpen;
  closed[0] = -kOpen;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const vec3 n = direction(i), e = irradiance(light, n);
    EXPECT_EQ(seenIrradiance(light.transfer, n, open, e), e);
    EXPECT_LT(glm::length(seenIrradiance(light.transfer, n, closed, e)), 0.02f * glm::length(e));
    for (const float r : {0.0f, 0.3f, 1.0f}) {
      EXPECT_EQ(seenHighlight(open, n, r), 1.0f);
      EXPECT_NEAR(seenHighlight(closed, n, r), 0.0f, 1e-6f);
    }
  }
}

// The smoother a surface, the nearer to V itself in the mirror's direction.
TEST(LightTransfer, HighlightsSeeWhatLiesAroundTheMirrorDirection) {
  for (std::uint64_t i = 0; i < 40; ++i) {
    Visibility v = randomVisibility(i);
    const vec3 mirror = direction(i);
    EXPECT_NEAR(seenHighlight(v, mirror, 0.04f), std::clamp(valueOf(v, mirror), 0.0f, 1.0f), 0.01f);
    double sum = 0, weight = 0;  // over the lobe of roughness 1, D(h) (n.l)
    const Frame3 frame(mirror);
    for (int k = 0; k < 20000; ++k) {
      const double z = (k + 0.5) / 20000, r = std::sqrt(1 - z * z), phi = 2.399963229728653 * k;
      const vec3 d = frame.toWorld(vec3(dvec3(r * std::cos(phi), r * std::sin(phi), z)));
      sum += z * static_cast<double>(valueOf(v, d));  // D is constant at roughness 1
      weight += z;
    }
    EXPECT_NEAR(seenHighlight(v, mirror, 1), sum / weight, 0.002);
  }
}

TEST(PreparedLight, OfAWidePanoramaIsThatOfItsReducedOne) {
  Image<vec3> wide(kWidestLight + 4, kWidestLight / 2 + 2, vec3(0.5f));
  wide(17, 900) = vec3(1000);
  const PreparedLight light = prepareLight(makeEnvironment(wide));
  EXPECT_EQ(light.radiance.width, kWidestLight);
  EXPECT_EQ(light.radiance.pixels, reducedPanorama(wide, kWidestLight, kWidestLight / 2).pixels);
}

// c_k of the world's directions as they are of the panorama's.
Visibility turnedBy(const LightTurn& turn, const Visibility& v) {
  const ShRotation rotation(dmat3(dvec3(turn({1, 0, 0})), dvec3(turn({0, 1, 0})), dvec3(turn({0, 0, 1}))));
  Visibility turned;
  rotation.apply(1, v.data(), turned.data());
  return turned;
}

TEST(LightTransfer, TurnsWithThePanorama) {
  Environment sky = lampedSky();
  const PreparedLight plain = prepareLight(sky);
  constexpr float kYaw = 0.7f;
  sky.yaw_rad = kYaw;
  const PreparedLight own = prepareLight(sky);
  const LightTurn turned(plain, kYaw), by_itself(own, 0);
  const TransferTables tables = turned.of(plain.transfer);
  for (std::uint64_t i = 0; i < 20; ++i) {
    const vec3 n = direction(i);
    const Visibility v = randomVisibility(i), a = turnedBy(turned, v), b = turnedBy(by_itself, v);
    const vec3 open = irradiance(plain, turned(n)), seen = seenIrradiance(plain.transfer, turned(n), a, open);
    EXPECT_LT(glm::length(seen - seenIrradiance(tables, turned(n), v, open)), 1e-4f * glm::length(open));
    for (int k = 0; k < kShCount; ++k) EXPECT_NEAR(a[k], b[k], 1e-6f);
    EXPECT_NEAR(valueOf(a, turned(n)), valueOf(v, n), 1e-5f);  // the function moves with the direction
  }
}

// --- Pictures ---

RenderScene litBall(float visibility_dc, float occlusion) {
  auto cloud = std::make_shared<GaussianCloud>();
  testing::addSphere(*cloud, vec3(0), 0.5f, 600);
  auto materials = testing::randomMaterials(cloud->size(), 7, 0.1f, 0.4f);
  std::fill(materials->ambient_occlusion.coefficients.begin(),
            materials->ambient_occlusion.coefficients.end(), 0.0f);
  for (std::size_t i = 0; i < cloud->size(); ++i)
    materials->ambient_occlusion.of(i)[0] = (occlusion - 0.5f) / kShC0;
  Attribute visibility{{.name = kVisibilityName, .channels = 1, .coefficients = kShCount},
                       std::vector<float>(cloud->size() * kShCount, 0.0f)};
  for (std::size_t i = 0; i < cloud->size(); ++i) visibility.values[i * kShCount] = visibility_dc;
  RenderScene scene;
  RenderInstance instance;
  instance.cloud = cloud;
  instance.materials = materials;
  instance.attributes =
      std::make_shared<const std::vector<Attribute>>(std::vector<Attribute>{std::move(visibility)});
  scene.instances = {instance};
  scene.environment = std::make_shared<const Environment>(lampedSky());
  return scene;
}

std::shared_ptr<const Planes> relit(RenderScene scene, const std::string& shadows) {
  scene.lighting.environment.shadows = shadows;
  const auto device = makeCpuDevice();
  const auto renderer = newCpuSceneRenderer(*device);
  renderer->load(scene);
  std::shared_ptr<const Planes> picture;
  Progress progress;
  const ChannelInfo asked[] = {channelOf(kRelightChannel)};
  renderer->draw(testing::cameraLookingAt({0, 0.5, 2}, {0, 0, 0}, 64, 80), asked, progress,
                 [&](const RenderedPicture& p) { picture = p.channels[0].values; });
  return picture;
}

double meanOf(const Planes& p) {
  double sum = 0;
  for (const float v : p.values) sum += v;
  return sum / static_cast<double>(p.values.size());
}

TEST(LightTransfer, OfAnOpenSurfaceIsThePictureWithoutOcclusion) {
  const auto with = relit(litBall(kOpen, 0.3f), "transfer"), without = relit(litBall(kOpen, 1), "ao");
  ASSERT_GT(meanOf(*without), 0.05);
  for (std::size_t i = 0; i < with->values.size(); ++i)
    EXPECT_NEAR(with->values[i], without->values[i], 0.005f * without->values[i] + 1e-5f);
}

TEST(LightTransfer, IsAutomaticWhereVisibilityIsThereAndAlone) {
  const RenderScene half = litBall(0, 1);
  const auto transfer = relit(half, "transfer"), by_itself = relit(half, "auto"), ao = relit(half, "ao");
  EXPECT_EQ(transfer->values, by_itself->values);
  EXPECT_LT(meanOf(*transfer), 0.8 * meanOf(*ao));
  EXPECT_EQ(relit(litBall(0, 0.2f), "transfer")->values, transfer->values) << "occlusion multiplied as well";
  const auto device = makeCpuDevice();
  const auto lacks = [&](const RenderScene& scene) {
    return lacksVisibility(scene, newCpuSceneRenderer(*device)->abilities());
  };
  EXPECT_FALSE(lacks(half));
  RenderScene bare = half;
  bare.instances[0].attributes = std::make_shared<const std::vector<Attribute>>();
  EXPECT_TRUE(lacks(bare));
  EXPECT_EQ(relit(bare, "transfer")->values, ao->values);
  bare.lighting.environment.shadows = "ao";
  EXPECT_FALSE(lacks(bare));
}

}  // namespace
}  // namespace beam
