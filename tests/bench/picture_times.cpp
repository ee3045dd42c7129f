// SPDX-License-Identifier: Apache-2.0
// What a picture of the studio costs beside the engine's own work, as ratios within one run: 140,000
// Gaussians with materials at 1280x720, the camera another one each time. Medians of the process's CPU time,
// all threads; no pass or fail here.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>

#include "core/optim/gaussian_model.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/scene/environment.h"
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
    body();
    all_.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  double median() {
    std::nth_element(all_.begin(), all_.begin() + static_cast<std::ptrdiff_t>(all_.size() / 2), all_.end());
    return all_[all_.size() / 2];
  }

 private:
  std::vector<double> all_;
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

}  // namespace

int main() {
  pictures();
  training();
}
