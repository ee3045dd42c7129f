// SPDX-License-Identifier: Apache-2.0
#include "core/method/fit_descent.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/math/color.h"
#include "core/optim/learning_rates.h"
#include "core/render/rasterizer_cache.h"

namespace beam {
namespace {

constexpr float kSsimWeight = 0.2f;  // methods 5.10
constexpr auto kDcRate = static_cast<float>(kFirstFrameRates.color);
constexpr auto kRestRate = static_cast<float>(kFirstFrameRates.color / kFirstFrameRates.rest_divisor);
static_assert(kRestRate == 1.25e-4f);
constexpr float kSlopeFloor = 1e-3f;  // where the slope of sRGB is taken at least

float encoded(MapKind kind, float v) {
  return kind == MapKind::BaseColor ? srgbFromLinear(std::max(v, 0.0f)) : v;
}
float slope(MapKind kind, float v) {
  return kind == MapKind::BaseColor ? srgbSlope(std::max(v, kSlopeFloor)) : 1.0f;
}

const Planes& valuesOf(const MaterialMaps& m, MapKind kind) {
  return kind == MapKind::BaseColor ? m.base_color : m.ambient_occlusion;
}
const Planes& weightsOf(const MaterialMaps& m, MapKind kind) {
  return kind == MapKind::BaseColor ? m.base_color_weight : m.ao_weight;
}

// Where the weight is 0 both sides are black, else both are scaled by it: a weighted L1, and SSIM of what
// counts.
class Loss {
 public:
  Loss(MapKind kind, TrainingOps& ops) : kind_(kind), ops_(ops) {}

  // dL/d(blended value), 3 planes.
  Planes gradient(const RasterImages& images, const MaterialMaps& m) {
    const Planes &values = valuesOf(m, kind_), &weights = weightsOf(m, kind_);
    const std::size_t n = images.alpha.planeSize();
    Planes seen(m.camera.width, m.camera.height, 3), wanted = seen, gradient;
    forPixels(n, [&](int c, std::size_t i) {
      const float value = values.plane(std::min(c, values.channels - 1))[i] * images.alpha.values[i];
      seen.plane(c)[i] = weights.values[i] * encoded(kind_, images.color.plane(c)[i]);
      wanted.plane(c)[i] = weights.values[i] * encoded(kind_, value);
    });
    ops_.photometric(seen, wanted, kSsimWeight, gradient);
    forPixels(n, [&](int c, std::size_t i) {
      gradient.plane(c)[i] *= weights.values[i] * slope(kind_, images.color.plane(c)[i]);
    });
    return gradient;
  }

 private:
  template <class Body>
  static void forPixels(std::size_t pixels, Body&& body) {
    parallelFor(pixels, 4096, [&](std::size_t begin, std::size_t end) {
      for (int c = 0; c < 3; ++c) {
        for (std::size_t i = begin; i < end; ++i) body(c, i);
      }
    });
  }

  MapKind kind_;
  TrainingOps& ops_;
};

void toPlanes(const ShBlock& block, GaussianBuffers& buffers) {
  for (std::size_t i = 0; i < buffers.count; ++i) {
    for (int k = 0; k < kShCount * 3; ++k) buffers.plane(PlaneLayout::kSh + k)[i] = block.of(i)[k];
  }
}

void addRegularization(const GaussianBuffers& values, float strength, GaussianBuffers& gradients) {
  for (int p = PlaneLayout::kSh + 3; p < PlaneLayout::kExtra; ++p) {
    const float* v = values.plane(p);
    float* g = gradients.plane(p);
    parallelFor(values.count, 1 << 14, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) g[i] += 2 * strength * v[i];
    });
  }
}

void addTemporal(const GaussianBuffers& values, const ShBlock& before, float weight,
                 GaussianBuffers& gradients) {
  if (weight == 0) return;
  for (int k = 0; k < kShCount * 3; ++k) {
    const float* v = values.plane(PlaneLayout::kSh + k);
    float* g = gradients.plane(PlaneLayout::kSh + k);
    parallelFor(values.count, 1 << 14, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) g[i] += 2 * weight * (v[i] - before.of(i)[k]);
    });
  }
}

}  // namespace

ShBlock fitDescent(std::span<const MaterialMaps> maps, const GaussianCloud& cloud, const ShBlock& start,
                   const DescentOptions& options, ComputeDevice& device, Progress& progress) {
  GaussianBuffers values = toBuffers(cloud), gradients(cloud.size()), first(cloud.size()),
                  second(cloud.size());
  toPlanes(start, values);
  std::vector<AdamPlane> rates(static_cast<std::size_t>(values.planes()));
  for (int p = PlaneLayout::kSh; p < PlaneLayout::kExtra; ++p) {
    rates[p].learning_rate = p < PlaneLayout::kSh + 3 ? kDcRate : kRestRate;
  }
  const auto ops = device.newTrainingOps();
  Loss loss(options.kind, *ops);
  RasterizerCache rasterizers(device);
  RasterImages images, upstream;
  const RandomStream choice(1, 0x666974, static_cast<int>(options.kind));
  progress.expect(options.iterations, "iterations");
  for (int step = 1; step <= options.iterations; ++step) {
    progress.step();
    const MaterialMaps& m = maps[choice.below(step, maps.size())];
    Rasterizer& rasterizer =
        rasterizers.of({.width = m.camera.width, .height = m.camera.height, .gradients = true});
    rasterizer.forward(values, m.camera, 3, vec3(0), images);
    upstream.color = loss.gradient(images, m);
    rasterizer.backward(upstream, gradients);
    addRegularization(values, static_cast<float>(options.regularization), gradients);
    addTemporal(values, start, static_cast<float>(options.temporal_weight), gradients);
    ops->adam(values, gradients, first, second, rates, {}, step);
  }
  ShBlock found(cloud.size(), 3);
  for (std::size_t i = 0; i < values.count; ++i) {
    for (int k = 0; k < kShCount * 3; ++k) found.of(i)[k] = values.plane(PlaneLayout::kSh + k)[i];
  }
  return found;
}

}  // namespace beam
