// SPDX-License-Identifier: Apache-2.0
// What a picture of the studio costs beside the engine's own work, as ratios within one run: 140,000
// Gaussians with materials at 1280x720, the camera another one each time. Medians of the process's CPU time,
// all threads; no pass or fail here.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>

#include "core/optim/gaussian_model.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/render/reference_scene_renderer.h"
#include "core/scene/environment.h"
#include "core/scene/thin_axis.h"
#include "tests/support/capsule_man.h"
#include "tests/support/three_balls.h"
#include "viewers/splat/splat_renderer.h"

namespace {

using namespace beam;

constexpr std::size_t kGaussians = 140000;
constexpr int kWidth = 1280, kHeight = 720, kRounds = 15;

class Times {
 public:
  void add(const std::function<void()>& body) {
    const std::clock_t start = std::clock();
    const auto wall = std::chrono::steady_clock::now();
    body();
    all_.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    wall_.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall).count());
  }
  double median() { return medianOf(all_); }
  std::string text() { return fmt::format("{:.1f} ({:.1f})", medianOf(all_), medianOf(wall_)); }

 private:
  static double medianOf(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }
  std::vector<double> all_, wall_;
};

void pictures() {
  const auto cloud = std::make_shared<const GaussianCloud>(testing::capsuleCloud(kGaussians));
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  SplatRenderer renderer(newCpuSceneRenderer(device));
  SplatRequest request;
  request.scene.instances = testing::sceneOf(cloud, testing::randomMaterials(kGaussians, 3, 0.05f, 0.5f));
  request.scene.environment =
      std::make_shared<const Environment>(makeEnvironment(Image<vec3>(64, 32, vec3(1), Encoding::Linear)));
  Progress progress;
  SplatPicture shown;  // the view holds the last one
  const auto draw = [&] {
    renderer.render(request, progress, [&](SplatPicture p) { shown = std::move(p); });
  };
  const auto raster =
      device->newRasterizer({.width = kWidth, .height = kHeight, .geometry = true, .extra_channels = 5});
  const GaussianBuffers buffers = toBuffers(*cloud, 5);
  RasterImages images;
  Times picture, turned, forward;
  for (int i = 0; i < kRounds; ++i) {
    Camera camera = testing::capsuleCamera(kWidth, kHeight);
    camera.camera_from_world.translation_m.x += 1e-3 * i;
    request.camera = camera;
    picture.add(draw);
    forward.add([&] { raster->forward(buffers, camera, 3, vec3(0), images); });
    request.scene.lighting.environment.rotation_deg += 6;
    turned.add(draw);
  }
  std::printf("forward %.1f ms; a picture from a new camera / forward %.3f; light turned / forward %.3f\n",
              forward.median(), picture.median() / forward.median(), turned.median() / forward.median());
}

// At the size of a photograph.
void training() {
  const GaussianCloud cloud = testing::capsuleCloud(kGaussians);
  const Camera camera = testing::capsuleCamera(480, 640);
  const auto device = makeCpuDevice();
  const auto raster = device->newRasterizer({.width = 480, .height = 640, .gradients = true});
  const auto ops = device->newTrainingOps();
  GaussianModel model(cloud);
  RasterImages images, upstream;
  upstream.color = Planes(480, 640, 3, 1e-4f);
  GaussianBuffers gradients;
  const Planes target(480, 640, 3, 0.4f);
  LearningRates still;  // the scene must not change under the clock
  still.position_m = still.rotation = still.log_scale = still.opacity_logit = still.color_dc =
      still.color_rest = 1e-12f;
  Times step, engine;
  for (int i = 0; i < kRounds; ++i) {
    step.add([&] {
      model.activate();
      raster->forward(model.physical(), camera, 3, vec3(0.5f), images);
      ops->photometric(images.color, target, 0.2f, upstream.color);
      raster->backward(upstream, gradients);
      model.step(gradients, still, 3, {}, i + 1, *ops);
    });
    model.activate();
    engine.add([&] {
      raster->forward(model.physical(), camera, 3, vec3(0.5f), images);
      raster->backward(upstream, gradients);
    });
  }
  std::printf("forward + backward %.1f ms; a training step / forward + backward %.3f\n", engine.median(),
              step.median() / engine.median());
}

// As a bake stores them, of bodies whose Gaussians all lie on their hulls.
std::shared_ptr<const std::vector<Attribute>> bakedAttributes(const GaussianCloud& cloud) {
  Attribute side{{.name = kNormalSideName}, std::vector<float>(cloud.size(), 1.0f)};
  Attribute visibility{{.name = kVisibilityName, .coefficients = kShCount},
                       std::vector<float>(cloud.size() * kShCount)};
  const vec3 center = centerOf(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const vec3 n = outwardAxis(cloud, i, center);
    if (glm::dot(n, thinAxis(cloud, i)) < 0) side.values[i] = -1;
    const auto basis = shBasis(n);
    for (int k = 0; k < kShCount; ++k) visibility.values[i * kShCount + k] = (k < 4 ? 0.5f : 0.1f) * basis[k];
  }
  return std::make_shared<const std::vector<Attribute>>(
      std::vector<Attribute>{std::move(side), std::move(visibility)});
}

// Relit pictures: a panorama past visibility and one lamp.
void lamps(int width, int height) {
  const auto cloud = std::make_shared<const GaussianCloud>(testing::capsuleCloud(kGaussians));
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  const auto renderer = newCpuSceneRenderer(device);
  RenderScene scene;
  scene.instances = testing::sceneOf(cloud, testing::randomMaterials(kGaussians, 3, 0.05f, 0.5f));
  scene.instances[0].attributes = bakedAttributes(*cloud);
  scene.environment =
      std::make_shared<const Environment>(makeEnvironment(Image<vec3>(64, 32, vec3(1), Encoding::Linear)));
  scene.lighting.lights = {newLight("sun", "directional")};
  auto& sun = std::get<DirectionalLight>(scene.lighting.lights[0].kind);
  Camera camera = testing::capsuleCamera(width, height);
  Progress progress;
  const ChannelInfo asked[] = {channelOf(kRelightChannel)};
  RenderedPicture shown;
  const auto draw = [&] {
    renderer->load(scene);
    renderer->draw(camera, asked, progress, [&](RenderedPicture p) { shown = std::move(p); });
  };
  // Four suns: what there is of lamps in a panorama, at most.
  Image<vec3> sunny(512, 256, vec3(1), Encoding::Linear);
  for (int i = 0; i < 4; ++i)
    for (int y = 60; y < 66; ++y)
      for (int x = 0; x < 6; ++x) sunny(40 + 120 * i + x, y + 10 * i) = vec3(300);
  const auto plain = scene.environment, suns = std::make_shared<const Environment>(makeEnvironment(sunny));
  Times moved, shadowed, open, turned, suns_turned;
  for (int i = 0; i < kRounds; ++i) {
    sun.shadows = true;
    draw();
    camera.camera_from_world.translation_m.x += 1e-3;
    moved.add(draw);
    sun.azimuth_deg += 5;
    shadowed.add(draw);
    sun.shadows = false;
    draw();
    sun.azimuth_deg += 5;
    open.add(draw);
    scene.lighting.lights[0].enabled = false;
    draw();
    scene.lighting.environment.rotation_deg += 6;
    turned.add(draw);
    scene.environment = suns;
    draw();
    scene.lighting.environment.rotation_deg += 6;
    suns_turned.add(draw);
    scene.environment = plain;
    scene.lighting.lights[0].enabled = true;
  }
  std::printf(
      "relit at %dx%d, CPU ms (wall ms): new camera %s; shadowed lamp turned %s; lamp without shadows %s; "
      "panorama turned %s; panorama with four lamps turned %s\n",
      width, height, moved.text().c_str(), shadowed.text().c_str(), open.text().c_str(),
      turned.text().c_str(), suns_turned.text().c_str());
}

// The reference at the size of a photograph: a primary hit, its light, one bounce and its light are a path.
void reference() {
  constexpr int kPaths = 8;
  const auto cloud = std::make_shared<const GaussianCloud>(testing::capsuleCloud(kGaussians));
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  RenderScene scene;
  scene.instances = testing::sceneOf(cloud, testing::randomMaterials(kGaussians, 3, 0.05f, 0.5f));
  scene.instances[0].attributes = bakedAttributes(*cloud);
  scene.environment =
      std::make_shared<const Environment>(makeEnvironment(Image<vec3>(64, 32, vec3(1), Encoding::Linear)));
  const Camera camera = testing::capsuleCamera(480, 640);
  const ChannelInfo asked[] = {channelOf(kRelightChannel), channelOf(kAlphaChannel)};
  double covered = 0;
  const auto timeOf = [&](int samples, int bounces) {
    const auto renderer =
        newReferenceSceneRenderer(device, {.samples = samples, .bounces = bounces, .denoise = false});
    renderer->load(scene);
    Progress progress;
    Times times;
    times.add([&] {
      renderer->draw(camera, asked, progress, [&](const RenderedPicture& p) {
        covered = static_cast<double>(std::count_if(p.channels[1].values->values.begin(),
                                                    p.channels[1].values->values.end(),
                                                    [](float a) { return a > 0.5f; }));
      });
    });
    return times;
  };
  timeOf(1, 1);  // builds what is kept of the device
  Times first = timeOf(1, 1), more = timeOf(1 + kPaths, 1), whole = timeOf(1 + kPaths, 2), one = timeOf(1, 2);
  const double cpu_s = 1e-3 * (more.median() - first.median());
  std::printf(
      "reference at 480x640, %.0f pixels covered: %.3f million paths a CPU second; 128 paths of two bounces "
      "a "
      "pixel are %.0f CPU s\n",
      covered, 1e-6 * covered * kPaths / cpu_s, 16e-3 * (whole.median() - one.median()));
}

}  // namespace

int main() {
  lamps(1920, 1080);
  lamps(1280, 720);
  reference();
  pictures();
  training();
}
