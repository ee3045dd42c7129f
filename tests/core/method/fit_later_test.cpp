// SPDX-License-Identifier: Apache-2.0
// Materials of frames that follow another: what the memory of the frame before must and must not do.
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/method/evaluate_motion.h"
#include "tests/core/method/material_fit.h"

namespace beam {
namespace {

constexpr double kEndless = 1e9;
const FitMaterialsOptions kAlone{.solver = "linear", .regularization = 0.01};

class LaterFit : public testing::MaterialFit {
 protected:
  Materials constant(float base_color, float occlusion) const {
    Materials m = blank();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      for (int c = 0; c < 3; ++c) m.base_color.of(i)[c] = (base_color - 0.5f) / kShC0;
      m.ambient_occlusion.of(i)[0] = (occlusion - 0.5f) / kShC0;
    }
    return m;
  }

  // View-dependent, of a different colour everywhere.
  Materials colorful() const {
    Materials m = blank();
    const RandomStream random(5);
    for (std::size_t i = 0; i < m.base_color.coefficients.size(); ++i)
      m.base_color.coefficients[i] = 0.2f * random.normal(i);
    for (std::size_t i = 0; i < m.ambient_occlusion.coefficients.size(); ++i)
      m.ambient_occlusion.coefficients[i] = 0.1f * random.normal(i + (1 << 20));
    for (std::size_t i = 0; i < cloud.size(); ++i)
      m.roughness[i] = 0.1f + 0.8f * random.uniform(i + (1 << 21));
    return m;
  }

  // As the rays of another frame would have missed it.
  static std::vector<MaterialMaps> noisy(std::vector<MaterialMaps> maps, int frame, float deviation) {
    for (std::size_t v = 0; v < maps.size(); ++v) {
      const RandomStream random(7, frame, static_cast<int>(v));
      Planes& color = maps[v].base_color;
      for (std::size_t i = 0; i < color.values.size(); ++i) color.values[i] += deviation * random.normal(i);
    }
    return maps;
  }

  Materials fitLater(std::span<const MaterialMaps> maps, const EarlierFrame& before,
                     const LaterMaterialsOptions& later) {
    Progress progress;
    FitMaterialsOptions options = kAlone;
    options.later = later;
    return fitLaterMaterials(sourceOf(maps), cloud, before, options, *device, progress);
  }
  Materials fitLater(std::span<const MaterialMaps> maps, const Materials& before,
                     const LaterMaterialsOptions& later) {
    return fitLater(maps, {cloud, before}, later);
  }

  // Mean of base colour and AO over what the cameras see.
  dvec2 seenMean(const Materials& m) {
    GBufferRenderer renderer(*device);
    dvec2 sum(0);
    double count = 0;
    for (const Camera& camera : cameras) {
      const GBuffer g = renderer.render(*residentOf(*device, cloud, &m), camera);
      for (std::size_t i = 0; i < g.alpha.pixels.size(); ++i) {
        if (g.alpha.pixels[i] < 0.9f) continue;
        sum += dvec2(g.base_color.pixels[i].x, g.ambient_occlusion.pixels[i]) / double(g.alpha.pixels[i]);
        ++count;
      }
    }
    return sum / count;
  }
};

TEST_F(LaterFit, WithEndlessMemoryIsTheFrameBefore) {
  const Materials before = colorful();
  const Materials found =
      fitLater(mapsOf(constant(0.3f, 0.8f)), before,
               {.memory_frames = kEndless, .occlusion_memory_frames = kEndless, .outlier = kEndless});
  for (std::size_t i = 0; i < before.base_color.coefficients.size(); ++i)
    ASSERT_NEAR(found.base_color.coefficients[i], before.base_color.coefficients[i], 1e-5) << i;
  for (std::size_t i = 0; i < before.ambient_occlusion.coefficients.size(); ++i)
    ASSERT_NEAR(found.ambient_occlusion.coefficients[i], before.ambient_occlusion.coefficients[i], 1e-5) << i;
}

TEST_F(LaterFit, WithoutMemoryIsTheFrameAlone) {
  const std::vector<MaterialMaps> maps = noisy(mapsOf(constant(0.3f, 0.8f)), 1, 0.05f);
  const Materials alone = fit(maps, kAlone);
  const Materials found = fitLater(maps, colorful(), {.memory_frames = 0, .occlusion_memory_frames = 0});
  EXPECT_EQ(found.base_color.coefficients, alone.base_color.coefficients);
  EXPECT_EQ(found.ambient_occlusion.coefficients, alone.ambient_occlusion.coefficients);
}

// (seen + memory before) / (1 + memory).
TEST_F(LaterFit, WeighsTheFrameBeforeAsSoManyFrames) {
  const std::vector<MaterialMaps> maps = mapsOf(constant(0.3f, 0.9f));
  for (const double memory : {1.0, 4.0}) {
    const dvec2 mean =
        seenMean(fitLater(maps, constant(0.6f, 0.5f),
                          {.memory_frames = memory, .occlusion_memory_frames = memory, .outlier = kEndless}));
    EXPECT_NEAR(mean.x, (0.3 + memory * 0.6) / (1 + memory), 0.025) << memory;
    EXPECT_NEAR(mean.y, (0.9 + memory * 0.5) / (1 + memory), 0.035) << memory;
  }
}

TEST_F(LaterFit, QuietsTheNoiseOfConstantTruthWithoutBias) {
  const Materials truth = constant(0.4f, 0.8f);
  const std::vector<MaterialMaps> clean = mapsOf(truth);
  Materials before, alone_before;
  double flicker = 0, alone_flicker = 0;
  for (int frame = 0; frame < 6; ++frame) {
    const std::vector<MaterialMaps> maps = noisy(clean, frame, 0.02f);
    const Materials alone = fit(maps, kAlone);
    const Materials now = frame == 0 ? alone : fitLater(maps, before, {});
    if (frame > 0) {
      flicker += baseColorFlicker(cloud, before, now);
      alone_flicker += baseColorFlicker(cloud, alone_before, alone);
    }
    before = now, alone_before = alone;
  }
  EXPECT_LT(flicker, 0.4 * alone_flicker);
  EXPECT_LT(difference(before, truth).rms, difference(alone_before, truth).rms);
  EXPECT_NEAR(seenMean(before).x, 0.4, 0.002);
}

// A Gaussian that slid from dark onto bright cloth.
TEST_F(LaterFit, ForgetsWhatThePicturesContradict) {
  const std::vector<MaterialMaps> maps = mapsOf(constant(0.6f, 0.8f));
  const Materials before = constant(0.2f, 0.8f);
  EXPECT_NEAR(seenMean(fitLater(maps, before, {.memory_frames = 4})).x, 0.6, 0.04);
  EXPECT_LT(seenMean(fitLater(maps, before, {.memory_frames = 4, .outlier = kEndless})).x, 0.45);
}

TEST_F(LaterFit, TurnsViewDependenceWithTheGaussian) {
  const Materials before = colorful();
  const GaussianCloud cloud_before = cloud;
  const quat turn = glm::angleAxis(1.1f, glm::normalize(vec3(1, 2, -1)));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.position_m[i] = turn * cloud.position_m[i];
    cloud.rotation[i] = turn * cloud.rotation[i];
    if (i % 2) cloud.rotation[i] = -cloud.rotation[i];
  }
  const Materials found =
      fitLater(mapsOf(before), {cloud_before, before},
               {.memory_frames = kEndless, .occlusion_memory_frames = kEndless, .outlier = kEndless});
  for (std::size_t i = 0; i < cloud.size(); i += 7) {
    const RandomStream random(9, static_cast<int>(i));
    const vec3 d = glm::normalize(vec3(random.normal(0), random.normal(1), random.normal(2)));
    const auto b = shBasis(d), turned = shBasis(turn * d);
    float expected = 0, got = 0;
    for (int k = 0; k < kShCount; ++k) {
      expected += b[k] * before.base_color.of(i)[k * 3 + 1];
      got += turned[k] * found.base_color.of(i)[k * 3 + 1];
    }
    EXPECT_NEAR(got, expected, 1e-4) << i;
  }
}

TEST_F(LaterFit, CarriesRoughness) {
  const Materials before = colorful();
  const std::vector<MaterialMaps> maps = mapsOf(before);
  EXPECT_EQ(fitLater(maps, before, {}).roughness, before.roughness);
  Progress progress;
  const FitMaterialsOptions adam{.adam_iterations = 1, .later = {.adam_iterations = 1}};
  EXPECT_EQ(fitLaterMaterials(sourceOf(maps), cloud, {cloud, before}, adam, *device, progress).roughness,
            before.roughness);
}

TEST_F(LaterFit, IsTheSameForAnyNumberOfThreads) {
  const std::vector<MaterialMaps> maps = noisy(mapsOf(constant(0.3f, 0.8f)), 1, 0.05f);
  const Materials before = colorful();
  setThreadCount(1);
  const Materials one = fitLater(maps, before, {});
  setThreadCount(2);
  const Materials two = fitLater(maps, before, {});
  setThreadCount(0);
  EXPECT_EQ(one.base_color.coefficients, two.base_color.coefficients);
  EXPECT_EQ(one.ambient_occlusion.coefficients, two.ambient_occlusion.coefficients);
}

TEST_F(LaterFit, ByAdamIsHeldByTheTemporalTerm) {
  const std::vector<MaterialMaps> maps = mapsOf(constant(0.3f, 0.8f));
  const Materials before = constant(0.4f, 0.7f);
  const auto meanWith = [&](double weight) {
    Progress progress;
    const FitMaterialsOptions options{.later = {.temporal_weight = weight, .adam_iterations = 150}};
    return seenMean(fitLaterMaterials(sourceOf(maps), cloud, {cloud, before}, options, *device, progress));
  };
  const dvec2 free = meanWith(0), held = meanWith(1);
  EXPECT_LT(free.x, 0.36);
  EXPECT_NEAR(held.x, 0.4, 0.002);
  EXPECT_NEAR(held.y, free.y, 1e-6);  // AO has no temporal term
  EXPECT_LT(meanWith(5e-3).x, 0.4);
}

TEST_F(LaterFit, RefusesOtherGaussians) {
  const Materials before = colorful();
  const GaussianCloud cloud_before = cloud;
  const std::vector<MaterialMaps> maps = mapsOf(before);
  testing::addSplat(cloud, {0, 0.3f, 0}, {0, 1, 0}, 0.02f, 0.002f);
  try {
    fitLater(maps, {cloud_before, before}, {});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Bug);
  }
}

}  // namespace
}  // namespace beam
