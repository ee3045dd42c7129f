// SPDX-License-Identifier: Apache-2.0
// Speed of the engine on the capsule man, in CPU time of the process. Counters do not depend on the
// machine: pairs evaluated per pair blended, keys per Gaussian. No pass or fail here.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/optim/gaussian_model.h"
#include "core/render/cpu/embree_tracer.h"
#include "core/render/cpu/splat_bvh.h"
#include "core/render/device.h"
#include "tests/support/capsule_man.h"

namespace {

using namespace beam;

struct Scene {
  GaussianCloud cloud;
  GaussianBuffers buffers;
  Camera camera;
  explicit Scene(const benchmark::State& s)
      : cloud(testing::capsuleCloud(static_cast<std::size_t>(s.range(0)))),
        buffers(toBuffers(cloud)),
        camera(testing::capsuleCamera(static_cast<int>(s.range(1)), static_cast<int>(s.range(2)))) {}
};

void addCounts(benchmark::State& s, const RasterCounts& n, std::size_t gaussians) {
  s.counters["evaluated_per_blended"] =
      static_cast<double>(n.pairs_evaluated) / static_cast<double>(n.pairs_blended);
  s.counters["keys_per_gaussian"] = static_cast<double>(n.keys) / static_cast<double>(gaussians);
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  s.counters["peak_MB"] = static_cast<double>(u.ru_maxrss) / 1024;
}

void forward(benchmark::State& s, bool geometry) {
  const Scene scene(s);
  const auto raster = makeCpuDevice()->newRasterizer(
      {.width = scene.camera.width, .height = scene.camera.height, .geometry = geometry});
  RasterImages images;
  for (auto _ : s) raster->forward(scene.buffers, scene.camera, 3, vec3(0.5f), images);
  addCounts(s, raster->counts(), scene.cloud.size());
}
void Forward(benchmark::State& s) { forward(s, false); }
void ForwardGeometry(benchmark::State& s) { forward(s, true); }

void forwardBackward(benchmark::State& s, bool geometry) {
  const Scene scene(s);
  const int w = scene.camera.width, h = scene.camera.height;
  const auto raster =
      makeCpuDevice()->newRasterizer({.width = w, .height = h, .geometry = geometry, .gradients = true});
  RasterImages images, upstream;
  upstream.color = Planes(w, h, 3, 1e-4f);
  if (geometry) upstream.normal = Planes(w, h, 3, 1e-4f), upstream.depth = Planes(w, h, 1, 1e-4f);
  GaussianBuffers gradients;
  for (auto _ : s) {
    raster->forward(scene.buffers, scene.camera, 3, vec3(0.5f), images);
    raster->backward(upstream, gradients);
  }
  addCounts(s, raster->counts(), scene.cloud.size());
}
void ForwardBackward(benchmark::State& s) { forwardBackward(s, false); }
void ForwardBackwardGeometry(benchmark::State& s) { forwardBackward(s, true); }

// E_color: activation, forward, L1 + D-SSIM, backward, chain to the raw parameters, Adam.
void TrainingStep(benchmark::State& s) {
  const Scene scene(s);
  const int w = scene.camera.width, h = scene.camera.height;
  const auto device = makeCpuDevice();
  const auto raster = device->newRasterizer({.width = w, .height = h, .gradients = true});
  const auto ops = device->newTrainingOps();
  GaussianModel model(scene.cloud);
  RasterImages images, upstream;
  GaussianBuffers gradients;
  const Planes target(w, h, 3, 0.4f);
  LearningRates still;  // the scene must not change under the clock
  still.position_m = still.rotation = still.log_scale = still.opacity_logit = still.color_dc =
      still.color_rest = 1e-12f;
  int step = 0;
  for (auto _ : s) {
    model.activate();
    raster->forward(model.physical(), scene.camera, 3, vec3(0.5f), images);
    ops->photometric(images.color, target, 0.2f, upstream.color);
    raster->backward(upstream, gradients);
    model.step(gradients, still, 3, {}, ++step, *ops);
  }
  addCounts(s, raster->counts(), scene.cloud.size());
}

void Ssim(benchmark::State& s) {
  const auto ops = makeCpuDevice()->newTrainingOps();
  Planes a(static_cast<int>(s.range(0)), static_cast<int>(s.range(1)), 3), b(a.width, a.height, 3);
  const RandomStream random(1);
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    a.values[i] = 0.5f + 0.3f * std::sin(0.01f * static_cast<float>(i)) + 0.1f * random.uniform(i);
    b.values[i] = a.values[i] + 0.05f * random.normal(i);
  }
  Planes g;
  for (auto _ : s) benchmark::DoNotOptimize(ops->photometric(a, b, 0.2f, g));
}

void Adam(benchmark::State& s) {
  const auto n = static_cast<std::size_t>(s.range(0));
  GaussianBuffers p(n), g(n), m(n), v(n);
  std::fill(g.values.begin(), g.values.end(), 1e-3f);
  const auto ops = makeCpuDevice()->newTrainingOps();
  const std::vector<AdamPlane> planes(p.planes(), {1e-4f});
  int step = 0;
  for (auto _ : s) ops->adam(p, g, m, v, planes, {}, ++step);
}

// Rays of ambient occlusion: 10 mm off the surface, cosine-distributed.
void occlusionRays(benchmark::State& s, const Tracer& tracer) {
  const std::vector<Ray> rays = testing::capsuleRays(4000, 50, 0.01f);
  std::vector<std::uint8_t> blocked(rays.size());
  for (auto _ : s) tracer.occluded(rays, blocked);
  s.SetItemsProcessed(s.iterations() * static_cast<std::int64_t>(rays.size()));
  s.counters["occluded_share"] =
      static_cast<double>(std::count(blocked.begin(), blocked.end(), 1)) / static_cast<double>(rays.size());
  s.counters["tracer_MB"] = static_cast<double>(tracer.memoryBytes()) * 1e-6;
}
// range(1): sigma of the cloud in millimetres.
GaussianCloud cloudForRays(const benchmark::State& s) {
  return testing::capsuleCloud(static_cast<std::size_t>(s.range(0)), 1e-3f * static_cast<float>(s.range(1)));
}
void OcclusionRays(benchmark::State& s) {
  occlusionRays(s, *makeCpuDevice()->newTracer({}, cloudForRays(s)));
}
void OcclusionRaysEmbree(benchmark::State& s) { occlusionRays(s, *makeEmbreeTracer({}, cloudForRays(s))); }

// The same rays as light paths follow them: what gets through, and where they end.
template <class Trace>
void blendedRays(benchmark::State& s, Trace&& trace) {
  const auto tracer = makeCpuDevice()->newTracer({}, cloudForRays(s));
  const std::vector<Ray> rays = testing::capsuleRays(4000, 50, 0.01f);
  for (auto _ : s) {
    parallelFor(rays.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) benchmark::DoNotOptimize(trace(*tracer, rays[i], i));
    });
  }
  s.SetItemsProcessed(s.iterations() * static_cast<std::int64_t>(rays.size()));
}
void TransmittanceRays(benchmark::State& s) {
  blendedRays(s, [](const Tracer& t, const Ray& ray, std::size_t) { return t.transmittance(ray); });
}
void DrawnRays(benchmark::State& s) {
  blendedRays(s, [](const Tracer& t, const Ray& ray, std::size_t i) { return t.drawn(ray, mixBits(i)); });
}

void TracerBuild(benchmark::State& s) {
  const GaussianCloud cloud = cloudForRays(s);
  for (auto _ : s) benchmark::DoNotOptimize(makeSplatBvhTracer({}, cloud));
}

// From the tree of the frame before.
void TracerFollow(benchmark::State& s) {
  const GaussianCloud cloud = cloudForRays(s);
  std::shared_ptr<const SplatBvh> tree;
  makeFollowingTracer({}, cloud, tree);
  for (auto _ : s) benchmark::DoNotOptimize(makeFollowingTracer({}, cloud, tree));
}

void sizes(benchmark::internal::Benchmark* b) {
  for (const std::int64_t n : {10000, 50000, 140000}) {
    b->Args({n, 480, 640});
    b->Args({n, 1920, 1080});
  }
  b->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
}

void clouds(benchmark::internal::Benchmark* b) {
  b->Args({140000, 6})->Args({140000, 3});
  b->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
}

}  // namespace

BENCHMARK(Forward)->Apply(sizes);
BENCHMARK(ForwardGeometry)->Apply(sizes);
BENCHMARK(ForwardBackward)->Apply(sizes);
BENCHMARK(ForwardBackwardGeometry)->Apply(sizes);
BENCHMARK(TrainingStep)->Apply(sizes);
BENCHMARK(Ssim)->Args({480, 640})->Args({1920, 1080})->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(Adam)->Arg(140000)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(OcclusionRays)->Apply(clouds);
BENCHMARK(OcclusionRaysEmbree)->Apply(clouds);
BENCHMARK(TransmittanceRays)->Apply(clouds);
BENCHMARK(DrawnRays)->Apply(clouds);
BENCHMARK(TracerBuild)->Apply(clouds);
BENCHMARK(TracerFollow)->Apply(clouds);

BENCHMARK_MAIN();
