// SPDX-License-Identifier: Apache-2.0
// Laws of the reference renderer: furnaces, albedo, the two ways to draw light, turns, and equal bits.
#include "core/render/reference_scene_renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/cpu_scene_renderer.h"
#include "hwy/highway.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/message_of.h"
#include "tests/support/reference_scene.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;

constexpr float kOffset_m = 0.01f;

// Three staggered layers: a ray gets through none of them.
GaussianCloud sheet() {
  GaussianCloud cloud;
  for (int layer = 0; layer < 3; ++layer) {
    addRectangle(cloud, vec3(0.007f * layer, -0.002f * layer, 0.004f * layer), vec3(0, 0, 0.6f),
                 vec3(0.6f, 0, 0), 0.02f);
  }
  cloud.opacity.assign(cloud.size(), 0.99f);
  return cloud;
}

RenderScene sheetIn(std::shared_ptr<const Environment> light, vec3 base_color, float roughness) {
  RenderScene scene;
  scene.instances = {gaussiansOf(sheet(), base_color, roughness)};
  scene.environment = std::move(light);
  return scene;
}

Camera above() { return cameraLookingAt({0, 2, 0.001}, {0, 0, 0}, 24, 100); }

struct Drawn {
  Planes relight, direct, indirect, variance;
  std::vector<int> samples;
};

Drawn drawn(const RenderScene& scene, const Camera& camera, const ReferenceOptions& options) {
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  const auto renderer = newReferenceSceneRenderer(device, options);
  EXPECT_TRUE(renderer->load(scene).empty());
  const std::vector<ChannelInfo> asked = {channelOf(kRelightChannel), channelOf(kDirectChannel),
                                          channelOf(kIndirectChannel), channelOf(kVarianceChannel)};
  Drawn out;
  Progress progress;
  renderer->draw(camera, asked, progress, [&](const RenderedPicture& p) {
    out.samples.push_back(p.samples);
    EXPECT_EQ(p.final, p.samples == options.samples);
    out.relight = *channelIn(p, kRelightChannel)->values;
    out.direct = *channelIn(p, kDirectChannel)->values;
    out.indirect = *channelIn(p, kIndirectChannel)->values;
    out.variance = *channelIn(p, kVarianceChannel)->values;
  });
  return out;
}

// rho L_D + L_S of methods 11.1, seen face on.
TEST(Reference, InAFurnaceASheetIsAsBrightAsTheClosedFormSays) {
  struct Row {
    float roughness, diffuse, specular;
  };
  for (const Row& row :
       {Row{0.3f, 0.9599f, 0.0396f}, Row{0.5f, 0.9599f, 0.0367f}, Row{1, 0.9599f, 0.0123f}}) {
    for (const bool denoise : {false, true}) {
      const Drawn d = drawn(sheetIn(uniform(), vec3(0.8f, 0.5f, 0.2f), row.roughness), above(),
                            {.samples = 64, .bounces = 0, .denoise = denoise, .offset_m = kOffset_m});
      const vec3 expected = vec3(0.8f, 0.5f, 0.2f) * row.diffuse + row.specular, mean = meanOf(d.relight);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / expected[c], 1, 0.005) << row.roughness;
      EXPECT_EQ(meanOf(d.indirect), vec3(0));
    }
  }
}

TEST(Reference, WithoutSpecularLightASurfaceReturnsItsAlbedo) {
  const vec3 albedo(0.7f, 0.4f, 0.1f);
  const Drawn d = drawn(sheetIn(uniform(), albedo, 0.5f), above(),
                        {.samples = 64, .denoise = false, .offset_m = kOffset_m, .specular = false});
  const vec3 mean = meanOf(d.relight);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / albedo[c], 1, 0.005);
}

std::shared_ptr<const Environment> oneTexel() {
  Image<vec3> map(32, 16, vec3(0), Encoding::Linear);
  map(5, 4) = vec3(40, 30, 20);
  return std::make_shared<const Environment>(makeEnvironment(std::move(map)));
}

TEST(Reference, LightDrawnByLightsBySurfaceAndByBothIsTheSame) {
  const RenderScene scene = sheetIn(oneTexel(), vec3(0.6f), 0.6f);
  ReferenceOptions options{.samples = 256, .bounces = 0, .denoise = false, .offset_m = kOffset_m};
  const vec3 both = meanOf(drawn(scene, above(), options).relight);
  ASSERT_GT(both.x, 0.1f);
  options.draws = LightDraws::OfLights;
  EXPECT_NEAR(meanOf(drawn(scene, above(), options).relight).x / both.x, 1, 0.01);
  options.draws = LightDraws::OfSurface;
  options.samples = 4096;
  EXPECT_NEAR(meanOf(drawn(scene, above(), options).relight).x / both.x, 1, 0.01);
}

// A ball on a sheet under a sky that differs to all sides.
RenderScene ballOnSheet(bool mirrored = false) {
  Image<vec3> map(64, 32, vec3(0), Encoding::Linear);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const int from = mirrored ? 63 - x : x;
      map(x, y) = y < 16 ? vec3(0.1f + 0.04f * static_cast<float>(from), 0.5f, 0.6f) : vec3(0.1f);
      if (from == 10 && y == 9) map(x, y) = vec3(60);
    }
  }
  RenderScene scene =
      sheetIn(std::make_shared<const Environment>(makeEnvironment(std::move(map))), vec3(0.6f), 0.6f);
  GaussianCloud ball;
  addSphere(ball, vec3(0.05f, 0.2f, 0), 0.18f, 900);
  scene.instances.push_back(gaussiansOf(std::move(ball), vec3(0.7f, 0.3f, 0.2f), 0.4f));
  return scene;
}

Camera aside(double azimuth) {
  return cameraLookingAt({1.2 * std::sin(azimuth), 0.8, 1.2 * std::cos(azimuth)}, {0, 0.1, 0}, 48, 70);
}

double meanDifference(const Planes& a, const Planes& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) sum += std::abs(a.values[i] - b.values[i]);
  return sum / static_cast<double>(a.values.size());
}

TEST(Reference, TurnedTogetherCameraLightAndBodyAreTheSamePictureAndAMirrorIsNot) {
  const ReferenceOptions options{.samples = 128, .denoise = false, .offset_m = kOffset_m};
  const RenderScene scene = ballOnSheet();
  RenderScene turned = scene;
  turned.lighting.environment.rotation_deg = 90;
  const Similarity3 turn{.rotation = dmat3(glm::mat3_cast(glm::angleAxis(kPi / 2, vec3(0, 1, 0))))};
  for (RenderInstance& i : turned.instances) i.world_from_cloud = turn;
  const Drawn a = drawn(scene, aside(0.3), options);
  ReferenceOptions others = options;
  others.seed = 2;
  const double noise = meanDifference(a.relight, drawn(scene, aside(0.3), others).relight);
  const double same = meanDifference(a.relight, drawn(turned, aside(0.3 + kPi / 2), options).relight);
  const double mirror = meanDifference(a.relight, drawn(ballOnSheet(true), aside(0.3), options).relight);
  EXPECT_LT(same, 1.3 * noise);
  EXPECT_GT(mirror, 2 * noise);
}

TEST(Reference, IsTheSameForEveryInstructionSetAndAnyNumberOfThreads) {
  const ReferenceOptions options{.samples = 4, .offset_m = kOffset_m};
  const Drawn usual = drawn(ballOnSheet(), aside(0.3), options);
  setThreadCount(1);
  EXPECT_EQ(drawn(ballOnSheet(), aside(0.3), options).relight.values, usual.relight.values);
  setThreadCount(0);
  forEveryInstructionSet([&](SimdTarget target) {
    const auto renderer = newReferenceSceneRenderer(makeCpuDevice(target), options);
    renderer->load(ballOnSheet());
    Progress progress;
    const std::vector<ChannelInfo> asked = {channelOf(kRelightChannel)};
    renderer->draw(aside(0.3), asked, progress, [&](const RenderedPicture& p) {
      if (p.final) {
        EXPECT_EQ(p.channels[0].values->values, usual.relight.values) << static_cast<int>(target);
      }
    });
  });
}

TEST(Reference, RefinesAndAddsUpAndTellsHowSureItIs) {
  const Drawn d = drawn(ballOnSheet(), aside(0.3), {.samples = 24, .denoise = false, .offset_m = kOffset_m});
  EXPECT_EQ(d.samples, (std::vector<int>{1, 2, 4, 8, 16, 24}));
  for (std::size_t i = 0; i < d.relight.values.size(); ++i)
    EXPECT_FLOAT_EQ(d.relight.values[i], d.direct.values[i] + d.indirect.values[i]);
  EXPECT_GT(meanOf(d.indirect).x, 0.01f);
  const Drawn more =
      drawn(ballOnSheet(), aside(0.3), {.samples = 96, .denoise = false, .offset_m = kOffset_m});
  double few = 0, many = 0;
  for (std::size_t i = 0; i < d.variance.values.size(); ++i)
    few += d.variance.values[i], many += more.variance.values[i];
  EXPECT_NEAR(many / few, 0.25, 0.1);
}

TEST(Reference, OfAConvexBodyIsWhatShadingGivesInRealTime) {
  GaussianCloud cloud;
  addSphere(cloud, vec3(0), 0.4f, 3000);
  RenderScene scene;
  scene.instances = {gaussiansOf(std::move(cloud), vec3(0.5f, 0.4f, 0.3f), 0.8f)};
  scene.environment = ballOnSheet().environment;
  scene.lighting.environment.shadows = kOcclusionAlone;
  const Camera camera = cameraLookingAt({0, 0.5, 2}, {0, 0, 0}, 48, 80);
  const Drawn d = drawn(scene, camera, {.samples = 64, .bounces = 0, .offset_m = kOffset_m});
  // Half occluded materials: of a scene without any the light is that of open surfaces.
  const auto materials = std::make_shared<Materials>(*scene.instances[0].materials);
  for (std::size_t i = 0; i < materials->roughness.size(); ++i)
    materials->ambient_occlusion.of(i)[0] = 0.5f / kShC0;
  scene.instances[0].materials = materials;
  const auto device = makeCpuDevice();
  const auto real_time = newCpuSceneRenderer(*device);
  real_time->load(scene);
  Progress progress;
  const ChannelInfo asked[] = {channelOf(kRelightChannel)};
  real_time->draw(camera, asked, progress, [&](const RenderedPicture& p) {
    const vec3 a = meanOf(*p.channels[0].values), b = meanOf(d.relight);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(b[c] / a[c], 1, 0.02);
  });
}

TEST(Reference, EndsWhenItIsStoppedAndRefusesNonsense) {
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { newReferenceSceneRenderer(device, {.samples = 0}); }),
              HasSubstr("--spp"));
  const auto renderer = newReferenceSceneRenderer(device, {.samples = 1024});
  renderer->load(ballOnSheet());
  std::stop_source stop;
  Progress progress(stop.get_token());
  int pictures = 0;
  const ChannelInfo asked[] = {channelOf(kRelightChannel)};
  EXPECT_THROW(renderer->draw(aside(0), asked, progress,
                              [&](const RenderedPicture&) {
                                ++pictures;
                                stop.request_stop();
                              }),
               Cancelled);
  EXPECT_EQ(pictures, 1);
}

}  // namespace
}  // namespace beam::testing
