// SPDX-License-Identifier: Apache-2.0
// The door of renderers, and the CPU behind it: the same values as the deferred path gives, bit for bit;
// what cannot be drawn is named or refused.
#include "core/render/scene_renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/render/deferred.h"
#include "tests/support/message_of.h"
#include "tests/support/splat_shapes.h"

namespace beam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Camera cameraAt(double x) {
  Camera c{{60, 60, 30, 25}, 60, 50, {}};
  c.camera_from_world.translation_m = dvec3(x, 0, 2);
  return c;
}
const Camera kCamera = cameraAt(0.1);

std::shared_ptr<const Environment> gradientSky() {
  Image<vec3> sky(64, 32, vec3(0), Encoding::Linear);
  for (std::size_t i = 0; i < sky.pixels.size(); ++i)
    sky.pixels[i] = vec3(0.2f + static_cast<float>(i % 64) / 64, 0.5f, 0.3f);
  return std::make_shared<const Environment>(makeEnvironment(std::move(sky)));
}

RenderInstance ball() {
  auto cloud = std::make_shared<GaussianCloud>();
  addSphere(*cloud, vec3(0), 0.5f, 300);
  RenderInstance instance;
  instance.cloud = cloud;
  instance.materials = randomMaterials(cloud->size(), 7, 0.1f, 0.4f);
  instance.attributes = std::make_shared<const std::vector<Attribute>>();
  return instance;
}

RenderScene litBall() {
  RenderScene scene;
  scene.instances = {ball()};
  scene.environment = gradientSky();
  return scene;
}

RenderedPicture drawn(SceneRenderer& renderer, const Camera& camera, const std::vector<ChannelInfo>& asked) {
  RenderedPicture picture;
  Progress progress;
  renderer.draw(camera, asked, progress, [&](RenderedPicture p) { picture = std::move(p); });
  return picture;
}

// All that litBall() can show.
std::vector<ChannelInfo> pictures() {
  const auto device = makeCpuDevice();
  const auto renderer = newCpuSceneRenderer(*device);
  std::vector<ChannelInfo> all;
  for (const ChannelInfo& c : channels())
    if (draws(renderer->abilities(), c) && lackOf(c, litBall()) == Lack::None) all.push_back(c);
  return all;
}

const std::vector<float>& valuesOf(const RenderedPicture& picture, const char* id) {
  return channelIn(picture, id)->values->values;
}

template <class T>
std::vector<float> planar(const Image<T>& image) {
  std::vector<float> values;
  for (int c = 0; c < static_cast<int>(sizeof(T) / sizeof(float)); ++c) {
    for (const T& pixel : image.pixels) values.push_back(reinterpret_cast<const float*>(&pixel)[c]);
  }
  return values;
}

TEST(CpuSceneRenderer, DrawsEveryPictureOfTheTableAsTheDeferredPathDoes) {
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  const auto renderer = newCpuSceneRenderer(device);
  RenderScene scene = litBall();
  scene.lighting.environment.rotation_deg = 90;
  scene.lighting.environment.gain = 2;
  EXPECT_THAT(renderer->load(scene), IsEmpty());
  const RenderedPicture picture = drawn(*renderer, kCamera, pictures());
  EXPECT_TRUE(picture.final);
  const RenderInstance& instance = scene.instances[0];
  const GBuffer g = GBufferRenderer(*device).render(
      *residentOf(*device, *instance.cloud, instance.materials.get()), kCamera);
  EXPECT_EQ(valuesOf(picture, kRgbChannel), planar(g.radiance));
  EXPECT_EQ(valuesOf(picture, kAlphaChannel), planar(g.alpha));
  EXPECT_EQ(valuesOf(picture, kDepthChannel), planar(g.depth_m));
  EXPECT_EQ(valuesOf(picture, kNormalChannel), planar(g.normal_world));
  EXPECT_EQ(valuesOf(picture, kBaseColorChannel), planar(g.base_color));
  EXPECT_EQ(valuesOf(picture, kOcclusionChannel), planar(g.ambient_occlusion));
  EXPECT_EQ(valuesOf(picture, kRoughnessChannel), planar(g.roughness));
  const Image<vec3> lit = shade(g, kCamera, prepareLight(*scene.environment),
                                {.yaw_rad = static_cast<float>(kPi / 2), .exposure = 2});
  EXPECT_EQ(valuesOf(picture, kRelightChannel), planar(lit));
  EXPECT_GT(lit(30, 25).x, 0.1f) << "it is no black picture";
}

TEST(CpuSceneRenderer, LeavesPicturesAloneThatAreStillLookedAt) {
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  renderer->load(litBall());
  const RenderedPicture first = drawn(*renderer, kCamera, pictures());
  const std::vector<float> before = valuesOf(first, kRelightChannel), depth = valuesOf(first, kDepthChannel);
  for (int i = 1; i < 4; ++i) drawn(*renderer, cameraAt(0.1 * i), pictures());
  EXPECT_EQ(valuesOf(first, kRelightChannel), before);
  EXPECT_EQ(valuesOf(first, kDepthChannel), depth);
}

// What is kept between pictures must not be seen in them.
TEST(CpuSceneRenderer, DrawsTheSameWhateverItDrewBefore) {
  const auto lights = std::make_shared<PreparedLights>();
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  const auto used = newCpuSceneRenderer(device, lights);
  RenderScene scene = litBall();
  const auto expectAsNew = [&](const Camera& camera) {
    used->load(scene);
    const auto fresh = newCpuSceneRenderer(device, lights);
    fresh->load(scene);
    const RenderedPicture a = drawn(*used, camera, pictures()), b = drawn(*fresh, camera, pictures());
    for (const ChannelInfo& c : pictures())
      EXPECT_EQ(valuesOf(a, c.id.c_str()), valuesOf(b, c.id.c_str())) << c.id;
  };
  expectAsNew(kCamera);
  scene.lighting.environment.rotation_deg = 40;
  expectAsNew(kCamera);
  expectAsNew(cameraAt(0.3));
  scene.environment = std::make_shared<const Environment>(makeEnvironment(Image<vec3>(16, 8, vec3(2))));
  expectAsNew(cameraAt(0.3));
  scene.instances[0].world_from_cloud.translation = dvec3(0.2, 0, 0);
  expectAsNew(cameraAt(0.3));
  scene.instances.push_back(ball());
  expectAsNew(kCamera);
}

// A channel that is a row of the table and an attribute of the Gaussians, and nothing else.
TEST(CpuSceneRenderer, DrawsAnAttributeThatOnlyATableKnows) {
  ChannelInfo speed;
  speed.id = "speed";
  speed.title = "Speed";
  speed.unit = "m/s";
  speed.attribute = "speed";
  speed.false_color = true;
  RenderScene scene = litBall();
  Attribute attribute;
  attribute.info.name = "speed";
  attribute.info.unit = "m/s";
  attribute.values.assign(scene.instances[0].cloud->size(), 3.0f);
  scene.instances[0].attributes = std::make_shared<const std::vector<Attribute>>(1, attribute);
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  EXPECT_TRUE(draws(renderer->abilities(), speed));
  renderer->load(scene);
  const RenderedPicture with =
      drawn(*renderer, kCamera, {speed, channelOf(kAlphaChannel), channelOf(kRelightChannel)});
  const auto &values = valuesOf(with, "speed"), &alpha = valuesOf(with, kAlphaChannel);
  ASSERT_EQ(values.size(), alpha.size());
  for (std::size_t i = 0; i < alpha.size(); ++i) EXPECT_NEAR(values[i], 3 * alpha[i], 1e-4f);
  const RenderedPicture without = drawn(*renderer, kCamera, {channelOf(kRelightChannel)});
  EXPECT_EQ(valuesOf(with, kRelightChannel), valuesOf(without, kRelightChannel));
}

TEST(CpuSceneRenderer, NamesWhatItDoesNotDraw) {
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  EXPECT_EQ(renderer->abilities().id, "cpu");
  EXPECT_FALSE(renderer->abilities().needs_context);
  EXPECT_FALSE(renderer->abilities().refines);
  RenderScene scene = litBall();
  scene.lighting.lights = {newLight("key", "rectangle"), newLight("off", "spot"), newLight("later", "tube")};
  scene.lighting.lights[1].enabled = false;
  scene.meshes.resize(1);
  scene.ground.enabled = true;
  scene.missing = {"mesh \"table.ply\": it is not there"};
  EXPECT_THAT(renderer->load(scene), ElementsAre("mesh \"table.ply\": it is not there",
                                                 "light \"later\" (tube) is not drawn by the renderer cpu",
                                                 "meshes are not drawn by the renderer cpu",
                                                 "the ground is not drawn by the renderer cpu"));
}

TEST(SceneRenderer, NamesLightsThatCastNoShadows) {
  RendererAbilities abilities;
  abilities.id = "gl";
  abilities.lights = {{"environment", false}, {"directional", false}, {"spot", true}};
  RenderScene scene;
  scene.lighting.lights = {newLight("sun", "directional"), newLight("spot", "spot"),
                           newLight("fill", "directional")};
  std::get<DirectionalLight>(scene.lighting.lights[2].kind).shadows = false;
  EXPECT_THAT(leftOut(scene, abilities),
              ElementsAre("light \"sun\" (directional) casts no shadows in the renderer gl"));
}

TEST(SceneRenderer, RefusesWhatItCannotDraw) {
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  const auto draw = [&](const ChannelInfo& channel) { drawn(*renderer, kCamera, {channel}); };
  EXPECT_THAT(messageOf(Error::Kind::Bug, [&] { draw(channelOf(kRgbChannel)); }), HasSubstr("before load"));
  RenderScene scene = litBall();
  scene.environment = nullptr;
  renderer->load(scene);
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { draw(channelOf(kMeshChannel)); }),
              HasSubstr("the renderer cpu does not draw mesh: it draws rgb, relight"));
  EXPECT_THAT(messageOf(Error::Kind::Bug, [&] { draw(channelOf(kRelightChannel)); }),
              HasSubstr("lacks what relight"));
  draw(channelOf(kRgbChannel));
}

TEST(SceneRenderer, StopsWhenItIsTold) {
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  renderer->load(litBall());
  std::stop_source stop;
  stop.request_stop();
  Progress progress(stop.get_token());
  const std::vector<ChannelInfo> asked = {channelOf(kRgbChannel)};
  EXPECT_THROW(renderer->draw(kCamera, asked, progress, [](RenderedPicture) { FAIL() << "no picture"; }),
               Cancelled);
}

TEST(PreparedLights, KeepNothingOfWhatWasStopped) {
  PreparedLights lights;
  const auto sky = gradientSky();
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(lights.of(sky, Progress(stop.get_token())), Cancelled);
  const auto light = lights.of(sky);
  EXPECT_EQ(light->levels.back().width, 64);
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  EXPECT_THROW(renderer->load(litBall(), Progress(stop.get_token())), Cancelled);
  renderer->load(litBall());
  EXPECT_NE(channelIn(drawn(*renderer, kCamera, {channelOf(kRelightChannel)}), kRelightChannel), nullptr);
}

TEST(PreparedLights, AreSharedAndForgottenWithTheirPanoramas) {
  PreparedLights lights;
  auto sky = gradientSky();
  const auto first = lights.of(sky);
  EXPECT_EQ(lights.of(sky), first);
  std::weak_ptr<const PreparedLight> watched = first;
  const auto other = lights.of(gradientSky());
  EXPECT_NE(other, first) << "another panorama, however alike";
  EXPECT_EQ(watched.use_count(), 2) << "held here and there";
  sky = nullptr;
  lights.of(gradientSky());
  EXPECT_EQ(watched.use_count(), 1) << "held here alone";
}

}  // namespace
}  // namespace beam::testing
