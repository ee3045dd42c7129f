// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/method/fit_linear.h"
#include "tests/core/method/material_fit.h"

namespace beam {
namespace {

using testing::MaterialFit;

TEST_F(MaterialFit, GivesConstantMapsBackExactly) {
  Materials truth = blank();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    truth.base_color.of(i)[0] = -1;
    truth.base_color.of(i)[1] = -0.5f;
    truth.base_color.of(i)[2] = 0.8f;
    truth.ambient_occlusion.of(i)[0] = 1.2f;
  }
  const Materials found = fit(mapsOf(truth), {.solver = "linear", .linear_iterations = 5});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int k = 0; k < kShCount * 3; ++k)
      EXPECT_NEAR(found.base_color.of(i)[k], truth.base_color.of(i)[k], 1e-3);
    EXPECT_NEAR(found.ambient_occlusion.of(i)[0], 1.2f, 1e-3);
  }
  EXPECT_EQ(found.roughness, std::vector<float>(cloud.size(), 0.5f));
}

TEST_F(MaterialFit, RecoversPlantedCoefficients) {
  Materials truth = blank();
  const RandomStream random(4);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int k = 0; k < 4; ++k) {  // degree 1: 24 cameras on one side of each splat determine it
      const float size = k == 0 ? 0.4f : 0.1f;
      for (int c = 0; c < 3; ++c)
        truth.base_color.of(i)[k * 3 + c] = size * random.normal(i * 64 + k * 4 + c);
      truth.ambient_occlusion.of(i)[k] = size * random.normal(i * 64 + k * 4 + 3);
    }
  }
  const Materials found = fit(mapsOf(truth), linear);
  const Difference d = difference(truth, found);
  EXPECT_LT(d.rms, 1e-3);
  EXPECT_LT(d.worst, 0.01f);
}

TEST_F(MaterialFit, LendsUnseenGaussiansTheColorOfTheirNeighbours) {
  Materials truth = blank();
  for (std::size_t i = 0; i < cloud.size(); ++i)
    truth.base_color.of(i)[0] = cloud.position_m[i].y > 0 ? 1.0f : -1.0f;
  std::vector<MaterialMaps> maps = mapsOf(truth);
  testing::addSplat(cloud, {0, 0.3f, 0}, {0, 1, 0}, 0.02f, 0.002f);  // buried under the top
  const Materials found = fit(maps, {.solver = "linear", .linear_iterations = 10});
  EXPECT_NEAR(found.base_color.of(cloud.size() - 1)[0], 1, 0.1);
}

TEST_F(MaterialFit, IgnoresPixelsWithoutWeight) {
  Materials truth = blank();
  for (std::size_t i = 0; i < cloud.size(); ++i) truth.base_color.of(i)[0] = 0.7f;
  std::vector<MaterialMaps> maps = mapsOf(truth);
  for (MaterialMaps& m : maps) {
    for (std::size_t i = 0; i < m.base_color_weight.values.size(); i += 3) {
      m.base_color_weight.values[i] = 0;
      for (int c = 0; c < 3; ++c) m.base_color.plane(c)[i] = 100;
    }
  }
  const Materials found = fit(maps, {.solver = "linear", .linear_iterations = 20});
  EXPECT_LT(difference(truth, found).worst, 1e-3f);
}

TEST_F(MaterialFit, IsTheSameForAnyNumberOfThreads) {
  Materials truth = blank();
  const RandomStream random(6);
  for (std::size_t i = 0; i < truth.base_color.coefficients.size(); ++i) {
    truth.base_color.coefficients[i] = 0.05f * random.normal(i);
  }
  const std::vector<MaterialMaps> maps = mapsOf(truth);
  setThreadCount(1);
  const Materials one = fit(maps, {.solver = "linear"});
  setThreadCount(2);
  const Materials two = fit(maps, {.solver = "linear"});
  setThreadCount(0);
  EXPECT_EQ(one.base_color.coefficients, two.base_color.coefficients);
  EXPECT_EQ(one.ambient_occlusion.coefficients, two.ambient_occlusion.coefficients);
}

TEST_F(MaterialFit, ByAdamAgreesWithTheLinearSolve) {
  Materials truth = blank();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int c = 0; c < 3; ++c) truth.base_color.of(i)[c] = -0.8f + 0.3f * c + cloud.position_m[i].x;
    truth.ambient_occlusion.of(i)[0] = 1 + cloud.position_m[i].y;
  }
  const std::vector<MaterialMaps> maps = mapsOf(truth);
  const Materials adam = fit(maps, {.solver = "adam", .adam_iterations = 1200, .regularization = 1e-6});
  EXPECT_LT(difference(truth, fit(maps, linear)).worst, 2e-3f);
  const Difference d = difference(truth, adam);
  EXPECT_LT(d.rms, 0.01);
}

TEST_F(MaterialFit, ACameraThatSeesNothingDoesNotLiftTheLimitOnMemory) {
  Materials truth = blank();
  const RandomStream random(7);
  for (std::size_t i = 0; i < truth.base_color.coefficients.size(); ++i)
    truth.base_color.coefficients[i] = 0.05f * random.normal(i);
  std::vector<MaterialMaps> maps = mapsOf(truth);
  const auto solved = [&](std::size_t most_entries) {
    Progress progress;
    const FitMaterialsOptions options{.solver = "linear", .linear_iterations = 3};
    return fitLinear(sourceOf(maps), cloud, nullptr, options, *device, progress, most_entries);
  };
  constexpr std::size_t kFew = 50'000;
  const MaterialCoefficients all = solved(kMostBlendWeights), some = solved(kFew);
  EXPECT_NE(all, some);
  MaterialMaps blind = maps.front();
  for (Planes* p : {&blind.ao_weight, &blind.base_color_weight})
    std::fill(p->values.begin(), p->values.end(), 0.0f);
  maps.insert(maps.begin(), blind);
  EXPECT_EQ(solved(kFew), some);
}

TEST_F(MaterialFit, NeedsAView) { EXPECT_THROW(fit({}, linear), Error); }

TEST_F(MaterialFit, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  Progress progress(stop.get_token());
  const std::vector<MaterialMaps> maps = mapsOf(blank());
  EXPECT_THROW(fitMaterials(sourceOf(maps), cloud, 0.5f, linear, *device, progress), Cancelled);
}

}  // namespace
}  // namespace beam
