// SPDX-License-Identifier: Apache-2.0
// The lamps of a panorama: which there are, that light is neither lost nor won, and their shadows.
#include "core/render/panorama_lamps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/rng.h"
#include "core/math/color.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/render/prepared_light.h"
#include "core/render/shadow_map.h"
#include "core/scene/thin_axis.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam {
namespace {

struct Disc {
  vec3 toward{0, 1, 0};
  float half_angle_rad = 0.05f;
  float times = 200;  // as bright as the sky
};

Image<vec3> skyWith(const std::vector<Disc>& discs, int width = 1024) {
  Image<vec3> sky(width, width / 2, vec3(0.5f, 0.6f, 0.8f), Encoding::Linear);
  for (int y = 0; y < sky.height; ++y) {
    for (int x = 0; x < width; ++x) {
      const vec3 d = directionFromLatLong({(x + 0.5f) / width, (y + 0.5f) / sky.height});
      for (const Disc& disc : discs)
        if (glm::dot(d, glm::normalize(disc.toward)) > std::cos(disc.half_angle_rad)) sky(x, y) *= disc.times;
    }
  }
  return sky;
}

vec3 direction(std::uint64_t i) {
  const RandomStream r(31);
  return glm::normalize(vec3(r.normal(3 * i), r.normal(3 * i + 1), r.normal(3 * i + 2)));
}

vec3 irradianceOf(const Image<vec3>& sky, vec3 n) {
  dvec3 sum(0);
  for (int y = 0; y < sky.height; ++y) {
    const double angle =
        2 * kPi / sky.width * (std::cos(kPi * y / sky.height) - std::cos(kPi * (y + 1) / sky.height));
    for (int x = 0; x < sky.width; ++x) {
      const vec3 d = directionFromLatLong({(x + 0.5f) / sky.width, (y + 0.5f) / sky.height});
      sum += angle * static_cast<double>(std::max(0.0f, glm::dot(n, d))) * dvec3(sky(x, y));
    }
  }
  return vec3(sum);
}

double degreesBetween(vec3 a, vec3 b) { return std::acos(std::min(1.0f, glm::dot(a, b))) * 180 / kPi; }

TEST(PanoramaLamps, OfAnEvenSkyOrOneOfBroadLightThereAreNone) {
  EXPECT_TRUE(splitPanorama(skyWith({})).lamps.empty());
  EXPECT_TRUE(splitPanorama(skyWith({{.half_angle_rad = 0.5f, .times = 8}})).lamps.empty());
  EXPECT_TRUE(splitPanorama(skyWith({{.half_angle_rad = 0.004f, .times = 100}})).lamps.empty()) << "too weak";
  EXPECT_TRUE(splitPanorama(Image<vec3>(64, 32, vec3(0))).lamps.empty());
}

// At the seam, at a pole and elsewhere.
TEST(PanoramaLamps, AreWhereTheDiscsAreAndAsWide) {
  for (const vec3& toward : std::vector<vec3>{{0, 1, 0}, {0, 0.2f, -1}, {1, 1, 0.4f}, {0.3f, -1, 0.1f}}) {
    const SplitPanorama split = splitPanorama(skyWith({{toward, 0.06f, 100}}));
    ASSERT_EQ(split.lamps.size(), 1u);
    const LightSource& lamp = split.lamps[0];
    EXPECT_TRUE(lamp.far);
    EXPECT_LT(degreesBetween(lamp.toward, glm::normalize(toward)), 0.1);
    EXPECT_NEAR(lamp.half_angle_rad, 0.06f, 0.003f);
    EXPECT_GT(lamp.strength.z, 1.5f * lamp.strength.x) << "of the colour of the sky";
  }
}

TEST(PanoramaLamps, AreTheFourStrongestStrongestFirst) {
  std::vector<Disc> discs;
  for (int i = 0; i < 6; ++i) discs.push_back({direction(40 + i), 0.05f, 200.0f + 60 * i});
  const SplitPanorama split = splitPanorama(skyWith(discs));
  ASSERT_EQ(split.lamps.size(), kMostPanoramaLamps);
  for (int i = 0; i < 4; ++i) EXPECT_LT(degreesBetween(split.lamps[i].toward, discs[5 - i].toward), 0.2) << i;
}

// A strip of light is no disc.
TEST(PanoramaLamps, OfAStripAreNarrowPiecesOfIt) {
  Image<vec3> sky = skyWith({});
  for (int x = 300; x < 520; ++x)
    for (int y = 200; y < 210; ++y) sky(x, y) *= 100;
  const SplitPanorama split = splitPanorama(sky);
  ASSERT_GE(split.lamps.size(), 2u);
  for (const LightSource& lamp : split.lamps) EXPECT_LE(lamp.half_angle_rad, 12 * kPi / 180);
}

// Of the mean irradiance, whichever way a surface faces: half a per cent, where bright discs graze it as
// well.
TEST(PanoramaLamps, AndTheRestGiveTheIrradianceOfTheWhole) {
  const Image<vec3> sky = skyWith(
      {{{1, 1, 0.4f}, 0.012f, 4000}, {{-1, 0.3f, 0.2f}, 0.08f, 60}, {{0, 0.2f, -1}, 0.03f, 400}}, 512);
  const SplitPanorama split = splitPanorama(sky);
  ASSERT_EQ(split.lamps.size(), 3u);
  double mean = 0;
  std::vector<double> off;
  for (std::uint64_t i = 0; i < 60; ++i) {
    vec3 n = direction(i);
    if (i >= 30) {  // across one of the lamps, where half of it is hidden
      const vec3 toward = split.lamps[i % 3].toward;
      n = glm::normalize(n - glm::dot(n, toward) * toward + 0.01f * toward);
    }
    vec3 sum = irradianceOf(split.rest, n);
    for (const LightSource& lamp : split.lamps)
      sum += cosineOfDisc(glm::dot(n, lamp.toward), lamp.half_angle_rad) * lamp.strength;
    const vec3 whole = irradianceOf(sky, n);
    mean += luminance(whole) / 60;
    off.push_back(std::abs(luminance(sum - whole)));
  }
  for (std::size_t i = 0; i < off.size(); ++i) EXPECT_LT(off[i], 0.005 * mean) << i;
}

TEST(PanoramaLamps, TurnWithThePanorama) {
  Environment sky = makeEnvironment(skyWith({{{1, 1, 0.4f}, 0.05f, 200}}));
  sky.yaw_rad = 0.4f;
  sky.gain = 3;
  const PreparedLight light = prepareLight(sky, Progress{}, PanoramaLamps::Apart);
  ASSERT_EQ(light.lamps.size(), 1u);
  const LightSource lamp = LightTurn(light, 0.7f).toWorld(light.lamps)[0];
  sky.yaw_rad += 0.7f;
  EXPECT_GT(radianceFrom(sky, lamp.toward).y, 300);
  const SplitPanorama split = splitPanorama(sky.radiance);
  EXPECT_NEAR(lamp.strength.y, 3 * split.lamps[0].strength.y, 1e-4f * lamp.strength.y);
  EXPECT_LT(luminance(prefiltered(light, split.lamps[0].toward, 0)), 3) << "still in the levels";
  EXPECT_TRUE(prepareLight(sky).lamps.empty());
}

// An edge at x = 0 in the plane z = 0, what is at x < 0 casts: the penumbra on a plane below is the part of
// the disc that the edge leaves.
TEST(PanoramaLamps, CastShadowsAsSoftAsTheyAreWide) {
  const LightSource source{.far = true, .toward = {0, 0, -1}, .strength = vec3(1)};
  ShadowMap map;
  map.views = shadowViewsOf(source, {vec3(0), 1});
  const ShadowView& view = map.views[0];
  const auto size = static_cast<std::size_t>(view.size);
  ShadowTexels texels{std::vector<float>(size * size, std::numeric_limits<float>::infinity()),
                      std::vector<float>(size * size, 1.0f)};
  for (std::size_t y = 0; y < size; ++y) {
    for (std::size_t x = 0; x < size; ++x) {
      const auto at = [&](std::size_t i) {
        return view.half_width * (2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(size) - 1);
      };
      const vec3 p = view.world_from_light * vec3(at(x), at(y), 0);
      if (p.x < 0) texels.front[y * size + x] = 0, texels.through[y * size + x] = 0;
    }
  }
  map.texels = {texels};
  constexpr float kHalfAngle = 0.1f;
  for (const float below_m : {0.2f, 0.5f}) {
    const float radius = below_m * std::tan(kHalfAngle);
    double off = 0;
    for (int i = -20; i <= 20; ++i) {
      const float s = static_cast<float>(i) / 16, x = s * radius;
      const float c = std::clamp(s, -1.0f, 1.0f),
                  open = 0.5f + (c * std::sqrt(1 - c * c) + std::asin(c)) / kPi;
      const float light = map.lightAt({x, 0.1f, below_m}, kHalfAngle);
      EXPECT_NEAR(light, open, 0.12f) << below_m << ' ' << s;
      off += std::abs(light - open) / 41;
    }
    EXPECT_LT(off, 0.05);
    EXPECT_EQ(map.lightAt({0.4f, 0, below_m}, kHalfAngle), 1);
    EXPECT_EQ(map.lightAt({-0.4f, 0, below_m}, kHalfAngle), 0);
  }
  EXPECT_EQ(map.lightAt({-0.1f, 0, -0.5f}, kHalfAngle), 1) << "before what casts";
  EXPECT_EQ(map.lightAt({0.01f, 0, 0.5f}, 0), 1) << "of a point the shadow is sharp";
}

// --- Pictures ---

constexpr float kOpen = 0.5f / kShC0;  // V = 1

RenderScene openBallUnder(const Image<vec3>& sky) {
  auto cloud = std::make_shared<GaussianCloud>();
  testing::addSphere(*cloud, vec3(0), 0.5f, 4000);
  auto materials = testing::randomMaterials(cloud->size(), 7, 0.0f, 0.5f);
  std::fill(materials->ambient_occlusion.coefficients.begin(),
            materials->ambient_occlusion.coefficients.end(), 0.0f);
  Attribute visibility{{.name = kVisibilityName, .channels = 1, .coefficients = kShCount},
                       std::vector<float>(cloud->size() * kShCount, 0.0f)};
  Attribute side{{.name = kNormalSideName, .channels = 1, .coefficients = 1}, {}};
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    materials->ambient_occlusion.of(i)[0] = 0.5f / kShC0;
    materials->roughness[i] = 1;
    visibility.values[i * kShCount] = kOpen;
    side.values.push_back(glm::dot(thinAxis(*cloud, i), cloud->position_m[i]) < 0 ? -1.0f : 1.0f);
  }
  RenderScene scene;
  RenderInstance instance;
  instance.cloud = cloud;
  instance.materials = materials;
  instance.attributes =
      std::make_shared<const std::vector<Attribute>>(std::vector<Attribute>{visibility, side});
  scene.instances = {instance};
  scene.environment = std::make_shared<const Environment>(makeEnvironment(sky));
  return scene;
}

Planes relit(RenderScene scene, const std::string& shadows) {
  scene.lighting.environment.shadows = shadows;
  const auto device = makeCpuDevice();
  const auto renderer = newCpuSceneRenderer(*device);
  renderer->load(scene);
  Planes picture;
  Progress progress;
  const ChannelInfo asked[] = {channelOf(kRelightChannel)};
  renderer->draw(testing::cameraLookingAt({0, 0.5, 2}, {0, 0, 0}, 64, 80), asked, progress,
                 [&](const RenderedPicture& p) { picture = *p.channels[0].values; });
  return picture;
}

double sumOf(const Planes& p) {
  double sum = 0;
  for (const float v : p.values) sum += v;
  return sum;
}

// Nothing stands in the way of an open ball: lamps of their own light it as the whole panorama does.
TEST(PanoramaLamps, LightAnOpenBallAsThePanoramaDoes) {
  const RenderScene scene = openBallUnder(skyWith({{{0.6f, 0.8f, 1}, 0.05f, 200}}));
  const Planes apart = relit(scene, "transfer"), within = relit(scene, "ao");
  EXPECT_NE(apart.values, within.values);
  EXPECT_NEAR(sumOf(apart) / sumOf(within), 1, 0.01);
}

// What is in the way of the lamp takes its light, though the visibility that was baked is 1.
TEST(PanoramaLamps, AreKeptOffByWhatStandsBefore) {
  const Image<vec3> sky = skyWith({{{0, 0, 1}, 0.02f, 20000}});
  RenderScene scene = openBallUnder(sky);
  const double alone = sumOf(relit(scene, "transfer"));
  RenderInstance shade = scene.instances[0];
  shade.world_from_cloud.translation = {0, 0, 4};  // behind the eye
  scene.instances.push_back(shade);
  const double shaded = sumOf(relit(scene, "transfer")), occluded = sumOf(relit(scene, "ao"));
  EXPECT_LT(shaded, 0.4 * alone);
  EXPECT_GT(occluded, 0.9 * alone) << "ambient occlusion knows no direction: all as it was";
}

}  // namespace
}  // namespace beam
