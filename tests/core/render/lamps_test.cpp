// SPDX-License-Identifier: Apache-2.0
// Lamps and their shadows: maps against rays, in real time against the reference, and equal bits.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/render/gaussian_surfaces.h"
#include "core/render/reference_scene_renderer.h"
#include "core/scene/gbuffer.h"
#include "core/scene/thin_axis.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam::testing {
namespace {

// Sides as a bake stores them, by the outward direction of each Gaussian.
template <class Outward>
RenderInstance instanceOf(GaussianCloud cloud, Outward&& outward) {
  Attribute side{{.name = kNormalSideName}, {}};
  for (std::size_t i = 0; i < cloud.size(); ++i)
    side.values.push_back(glm::dot(thinAxis(cloud, i), outward(cloud.position_m[i])) < 0 ? -1.0f : 1.0f);
  cloud.opacity.assign(cloud.size(), 0.99f);
  RenderInstance instance;
  auto materials = std::make_shared<Materials>();
  materials->roughness.assign(cloud.size(), 0.7f);
  materials->base_color = ShBlock(cloud.size(), 3);
  materials->ambient_occlusion = ShBlock(cloud.size(), 1);
  instance.materials = materials;
  instance.cloud = std::make_shared<const GaussianCloud>(std::move(cloud));
  instance.attributes = std::make_shared<const std::vector<Attribute>>(std::vector<Attribute>{side});
  return instance;
}

RenderInstance ball(vec3 center, float radius_m, int count) {
  GaussianCloud cloud;
  addSphere(cloud, center, radius_m, count);
  return instanceOf(std::move(cloud), [=](vec3 p) { return p - center; });
}

RenderInstance withoutSides(RenderInstance instance) {
  instance.attributes = std::make_shared<const std::vector<Attribute>>();
  return instance;
}

// A large ball, and a small one over it.
std::vector<RenderInstance> twoBalls() {
  return {ball(vec3(0), 0.4f, 6000), ball(vec3(0.1f, 0.7f, 0.1f), 0.12f, 1200)};
}

template <class Kind>
Light lampOf(const Kind& kind, const char* id = "key") {
  Light light;
  light.id = id;
  light.kind = kind;
  return light;
}

std::vector<Light> lampsOfAllKinds() {
  return {lampOf(DirectionalLight{.azimuth_deg = 30, .elevation_deg = 70}),
          lampOf(PointLight{.position_m = dvec3(0.4, 2, 0.2)}),
          lampOf(PointLight{.position_m = dvec3(0.2, 0.9, 0.1)}),  // close by: six faces
          lampOf(SpotLight{.position_m = dvec3(0.4, 1.6, 0.5),
                           .target_m = dvec3(0, 0.3, 0),
                           .inner_deg = 30,
                           .outer_deg = 60}),
          lampOf(RectangleLight{
              .position_m = dvec3(0.3, 1.9, 0.6), .target_m = dvec3(0), .width_m = 0.4, .height_m = 0.3})};
}

struct Maps {
  std::shared_ptr<ComputeDevice> device;
  std::unique_ptr<ResidentScene> resident = device->newResidentScene();
  std::unique_ptr<ShadowDrawer> drawer = device->newShadowDrawer();

  explicit Maps(const std::vector<RenderInstance>& instances, SimdTarget target = SimdTarget::Auto)
      : device(makeCpuDevice(target)) {
    resident->load(instances);
  }
  ShadowMap of(const LightSource& source) {
    return drawer->mapOf(*resident, source, drawer->boundsOf(*resident));
  }
};

// Of points on the large ball that face the light: the share for which the map says lit or shadowed as a ray
// does, and the share that it shadows though no ray near by is.
struct Agreement {
  double same = 0, acne = 0, shadowed = 0;
};
Agreement agreement(const std::vector<RenderInstance>& instances, const LightSource& source) {
  Maps maps(instances);
  const ShadowMap map = maps.of(source);
  const GaussianSurfaces rays(instances, *maps.device);
  const GaussianCloud& cloud = *instances[0].cloud;
  Agreement a;
  int count = 0;
  std::vector<vec3> dark, wrong;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const vec3 x = cloud.position_m[i], n = glm::normalize(x);
    const ArrivingLight light = arrivingAt(source, x);
    if (glm::dot(n, light.toward) <= 0.05f) continue;
    const vec3 o = x + kShadowOffset_m * n, to = source.far ? source.toward : source.position_m - o;
    const float distance_m = source.far ? kEndless_m : glm::length(to);
    const bool lit = rays.transmittance(o, glm::normalize(to), distance_m) > 0.5f,
               drawn = map.lightAt(o) > 0.5f;
    ++count;
    a.same += lit == drawn;
    if (!lit) dark.push_back(x);
    if (lit && !drawn) wrong.push_back(x);
  }
  for (const vec3& x : wrong)
    a.acne +=
        std::none_of(dark.begin(), dark.end(), [&](const vec3& d) { return glm::length(x - d) < 0.03f; });
  a.same /= count, a.acne /= count;
  a.shadowed = static_cast<double>(dark.size()) / count;
  return a;
}

TEST(ShadowMap, AgreesWithRaysForEveryKindOfLamp) {
  for (const Light& light : lampsOfAllKinds()) {
    for (const LightSource& source : sourcesOf(light)) {
      const Agreement a = agreement(twoBalls(), source);
      EXPECT_GT(a.shadowed, 0.005) << kindOf(light);
      EXPECT_GT(a.same, 0.98) << kindOf(light);
      EXPECT_EQ(a.acne, 0) << kindOf(light);
    }
  }
}

TEST(ShadowMap, HasOneViewFromOutsideAndSixFromWithin) {
  const Sphere body{.center_m = vec3(0, 1, 0), .radius_m = 1};
  const auto views = [&](vec3 position_m) {
    return shadowViewsOf({.position_m = position_m, .strength = vec3(1)}, body).size();
  };
  EXPECT_EQ(shadowViewsOf({.far = true, .toward = vec3(0, 1, 0)}, body).size(), 1u);
  EXPECT_EQ(views({0, 1, 3}), 1u);
  EXPECT_EQ(views({0, 1, 1.1f}), 6u);
  EXPECT_EQ(views({0, 1, 0.2f}), 6u);
  EXPECT_EQ(views({0, 1, 0}), 6u);
}

TEST(ShadowMap, OfGaussiansWithoutSidesKeepsItsDistance) {
  std::vector<RenderInstance> instances;
  for (const RenderInstance& i : twoBalls()) instances.push_back(withoutSides(i));
  Maps maps(instances);
  const LightSource sun = sourcesOf(lampsOfAllKinds()[0])[0];
  const ShadowMap map = maps.of(sun);
  EXPECT_GE(map.bias_m, kShadowBias_m);
  int lit = 0, count = 0;
  for (const vec3& x : instances[0].cloud->position_m) {
    const vec3 n = glm::normalize(x);
    if (glm::dot(n, sun.toward) < 0.3f || glm::length(vec2(x.x - 0.1f, x.z - 0.1f)) < 0.35f) continue;
    ++count;
    lit += map.lightAt(x + kShadowOffset_m * n) > 0.5f;
  }
  ASSERT_GT(count, 100);
  EXPECT_GT(lit, 0.99 * count);
}

TEST(ShadowMap, OfManyFaintGaussiansDarkensBehindThem) {
  GaussianCloud cloud;
  for (int layer = 0; layer < 8; ++layer)
    addRectangle(cloud, vec3(0, 0.02f * static_cast<float>(layer), 0), vec3(0, 0, 0.3f), vec3(0.3f, 0, 0),
                 0.02f);
  RenderInstance veil = instanceOf(std::move(cloud), [](vec3) { return vec3(0, -1, 0); });
  auto faint = std::make_shared<GaussianCloud>(*veil.cloud);
  faint->opacity.assign(faint->size(), 0.05f);  // none of them has a nearest depth
  veil.cloud = faint;
  Maps maps({veil});
  const ShadowMap map = maps.of({.far = true, .toward = vec3(0, 1, 0), .strength = vec3(1)});
  const float below = map.lightAt({0, -0.1f, 0});
  EXPECT_GT(below, 0);
  EXPECT_LT(below, 0.5f);
  EXPECT_EQ(map.lightAt({0, 0.5f, 0}), 1);
  EXPECT_EQ(map.lightAt({2, -0.1f, 0}), 1);
}

TEST(ShadowMap, IsTheSameForEveryInstructionSetAndAnyNumberOfThreads) {
  const auto mapsBy = [](SimdTarget target) {
    Maps maps(twoBalls(), target);
    std::vector<float> all;
    for (const Light& light : lampsOfAllKinds()) {
      for (const ShadowTexels& t : maps.of(sourcesOf(light)[0]).texels) {
        all.insert(all.end(), t.front.begin(), t.front.end());
        all.insert(all.end(), t.through.begin(), t.through.end());
      }
    }
    return all;
  };
  const std::vector<float> usual = mapsBy(SimdTarget::Auto);
  setThreadCount(1);
  EXPECT_TRUE(mapsBy(SimdTarget::Auto) == usual);
  setThreadCount(0);
  forEveryInstructionSet(
      [&](SimdTarget target) { EXPECT_TRUE(mapsBy(target) == usual) << static_cast<int>(target); });
}

RenderScene litBy(std::vector<Light> lights) {
  RenderScene scene;
  scene.instances = twoBalls();
  scene.lighting.lights = std::move(lights);
  return scene;
}

Planes drawn(SceneRenderer& renderer, const RenderScene& scene, const char* channel = kRelightChannel) {
  EXPECT_THAT(renderer.load(scene), ::testing::IsEmpty());
  Planes values;
  Progress progress;
  const ChannelInfo asked[] = {channelOf(channel)};
  renderer.draw(cameraLookingAt({0.4, 1.6, 2}, {0, 0.2, 0}, 64, 90), asked, progress,
                [&](const RenderedPicture& p) { values = *p.channels[0].values; });
  return values;
}

double sumOf(const Planes& p) {
  double sum = 0;
  for (const float v : p.values) sum += v;
  return sum;
}

TEST(Lamps, InRealTimeAreThoseOfTheReference) {
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  const auto real_time = newCpuSceneRenderer(device);
  const auto reference =
      newReferenceSceneRenderer(device, {.samples = 64, .denoise = false, .offset_m = kShadowOffset_m});
  for (const Light& light : lampsOfAllKinds()) {
    const RenderScene scene = litBy({light});
    const Planes fast = drawn(*real_time, scene), slow = drawn(*reference, scene, kDirectChannel);
    ASSERT_GT(sumOf(slow), 0) << kindOf(light);
    EXPECT_NEAR(sumOf(fast) / sumOf(slow), 1, 0.03) << kindOf(light);
    double difference = 0;
    for (std::size_t i = 0; i < fast.values.size(); ++i)
      difference += std::abs(fast.values[i] - slow.values[i]);
    EXPECT_LT(difference / sumOf(slow), 0.08) << kindOf(light);
  }
}

TEST(Lamps, OfARectangleAreDrawnAndHitAlike) {
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  const RenderScene scene = litBy({lampsOfAllKinds().back()});
  ReferenceOptions options{.samples = 64, .bounces = 0, .denoise = false, .offset_m = kShadowOffset_m};
  const double both = sumOf(drawn(*newReferenceSceneRenderer(device, options), scene));
  options.draws = LightDraws::OfLights;
  EXPECT_NEAR(sumOf(drawn(*newReferenceSceneRenderer(device, options), scene)) / both, 1, 0.01);
  options.draws = LightDraws::OfSurface;
  options.samples = 1024;
  EXPECT_NEAR(sumOf(drawn(*newReferenceSceneRenderer(device, options), scene)) / both, 1, 0.01);
}

TEST(Lamps, AddUpWithEachOtherAndThePanorama) {
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  const std::vector<Light> lamps = lampsOfAllKinds();
  RenderScene all = litBy({lamps[0], lamps[1]});
  all.lighting.lights[1].id = "fill";
  all.environment = std::make_shared<const Environment>(makeEnvironment(Image<vec3>(32, 16, vec3(0.3f))));
  const Planes together = drawn(*renderer, all);
  RenderScene sky = all;
  sky.lighting.lights.clear();
  RenderScene dark = all;
  dark.lighting.environment.enabled = false;
  const Planes by_sky = drawn(*renderer, sky), by_lamps = drawn(*renderer, dark);
  const Planes first = drawn(*renderer, litBy({lamps[0]})), second = drawn(*renderer, litBy({lamps[1]}));
  for (std::size_t i = 0; i < together.values.size(); ++i) {
    ASSERT_NEAR(together.values[i], by_sky.values[i] + by_lamps.values[i], 1e-4f);
    ASSERT_NEAR(by_lamps.values[i], first.values[i] + second.values[i], 1e-4f);
  }
}

TEST(Lamps, WithoutShadowsReachWhatOthersDoNot) {
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  const auto real_time = newCpuSceneRenderer(device);
  DirectionalLight sun{.azimuth_deg = 30, .elevation_deg = 70};
  const double shadowed = sumOf(drawn(*real_time, litBy({lampOf(sun)})));
  sun.shadows = false;
  const RenderScene open = litBy({lampOf(sun)});
  const double lit = sumOf(drawn(*real_time, open));
  EXPECT_GT(lit, 1.01 * shadowed);
  const auto reference =
      newReferenceSceneRenderer(device, {.samples = 16, .denoise = false, .offset_m = kShadowOffset_m});
  EXPECT_NEAR(sumOf(drawn(*reference, open, kDirectChannel)) / lit, 1, 0.03);
}

// More maps than are kept at a time: six of each of eight places.
TEST(Lamps, OfManyMapsAddUpAsOneByOne) {
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  std::vector<Light> boxes;
  std::vector<float> sum;
  for (int i = 0; i < 4; ++i) {
    const RectangleLight box{.position_m = dvec3(0.5, 0.6 + 0.1 * i, 0.2), .target_m = dvec3(0)};
    boxes.push_back(lampOf(box, fmt::format("box{}", i).c_str()));
    const Planes one = drawn(*renderer, litBy({boxes.back()}));
    sum.resize(one.values.size());
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += one.values[k];
  }
  const Planes all = drawn(*renderer, litBy(boxes));
  for (std::size_t k = 0; k < sum.size(); ++k) ASSERT_NEAR(all.values[k], sum[k], 1e-4f * (1 + sum[k]));
}

// A fringe lies where its Gaussians are, not at the eye, where this lamp is without end.
TEST(Lamps, AtTheEyeLightFringesAsTheSurfaceBesideThem) {
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  const RenderScene scene = litBy({lampOf(PointLight{.position_m = dvec3(0.4, 1.6, 2), .intensity = 4})});
  const Planes light = drawn(*renderer, scene), alpha = drawn(*renderer, scene, kAlphaChannel);
  float inside = 0, fringe = 0;
  for (std::size_t i = 0; i < alpha.values.size(); ++i) {
    if (alpha.values[i] < kVisibleAlpha) continue;
    float& brightest = alpha.values[i] >= kDepthAlpha ? inside : fringe;
    brightest = std::max(brightest, light.values[i] / alpha.values[i]);
  }
  EXPECT_GT(fringe, 0);
  EXPECT_LT(fringe, 2 * inside);
}

TEST(Lamps, InsideTheSubjectAreNamed) {
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  const auto said = [&](dvec3 position_m) {
    RenderScene scene = litBy({lampOf(PointLight{.position_m = position_m})});
    scene.instances[0].world_from_cloud.translation = dvec3(0, 0, 1);
    return renderer->load(scene);
  };
  EXPECT_THAT(said({0, 0, 1}), ::testing::ElementsAre("light \"key\" is inside the subject"));
  EXPECT_THAT(said({0, 0.3, 1.1}), ::testing::SizeIs(1));
  EXPECT_THAT(said({0, 0, 0}), ::testing::IsEmpty());  // where it was before it was moved
  EXPECT_THAT(said({0, 0.45, 1}), ::testing::IsEmpty());
}

TEST(Lamps, OneAfterTheOtherAreAsFreshOnesAre) {
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  const auto used = newCpuSceneRenderer(device);
  for (const Light& light : lampsOfAllKinds()) {
    const RenderScene scene = litBy({light});
    const Planes kept = drawn(*used, scene);
    EXPECT_EQ(kept.values, drawn(*newCpuSceneRenderer(device), scene).values);
    EXPECT_EQ(kept.values, drawn(*used, scene).values);
  }
}

}  // namespace
}  // namespace beam::testing
