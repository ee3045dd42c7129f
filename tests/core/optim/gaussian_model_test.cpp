// SPDX-License-Identifier: Apache-2.0
// Laws of the parameters under optimisation: activation and its chain rule, relocation, growth.
#include "core/optim/gaussian_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/optim/mcmc.h"

namespace beam {
namespace {

const LearningRates kRates = ratesAt(kFirstFrameRates, 0, 1, 1);

using L = PlaneLayout;

GaussianCloud someCloud(std::size_t n) {
  GaussianCloud c;
  c.color = ShBlock(n, 3);
  for (std::size_t i = 0; i < n; ++i) {
    const auto t = static_cast<float>(i);
    c.position_m.emplace_back(0.01f * t, 0.02f * t, 0.0f);
    c.rotation.push_back(glm::normalize(quat(1, 0.1f * t, 0.2f, 0.3f)));
    c.scale_m.emplace_back(0.005f + 0.001f * t, 0.004f, 0.001f);
    c.opacity.push_back(0.1f + 0.8f * t / static_cast<float>(n));
  }
  return c;
}

Camera cameraInFront() {
  Camera c;
  c.intrinsics = {500, 500, 100, 100};
  c.width = c.height = 200;
  c.camera_from_world.translation_m = dvec3(0, 0, 2);
  return c;
}

// Records the gradients that reach Adam and moves nothing.
class RecordingOps final : public TrainingOps {
 public:
  GaussianBuffers seen;
  PhotometricLoss photometric(const Planes&, const Planes&, float, Planes&) override { return {}; }
  void adam(GaussianBuffers&, const GaussianBuffers& gradients, GaussianBuffers&, GaussianBuffers&,
            std::span<const AdamPlane>, const AdamSettings&, int) override {
    seen = gradients;
  }
};

// A linear function of the physical values: its derivative by the raw ones is what the chain rule must give.
double score(const GaussianCloud& cloud, float filter_strength, const std::vector<Camera>& cameras) {
  GaussianModel m(cloud);
  m.updateFilter(cameras, filter_strength);
  m.activate();
  return 0.7 * m.physical().plane(L::kScale)[1] - 1.3 * m.physical().plane(L::kScale + 2)[1] +
         0.4 * m.physical().plane(L::kOpacity)[1];
}

TEST(GaussianModel, WithoutAFilterThePhysicalValuesAreTheClouds) {
  const GaussianCloud c = someCloud(5);
  GaussianModel m(c);
  m.activate();
  for (std::size_t i = 0; i < c.size(); ++i) {
    EXPECT_NEAR(m.physical().plane(L::kScale)[i], c.scale_m[i].x, 1e-8f);
    EXPECT_NEAR(m.physical().plane(L::kOpacity)[i], c.opacity[i], 1e-6f);
  }
}

TEST(GaussianModel, TheFilterGrowsScalesAndKeepsTheIntegralOfOpacity) {
  const GaussianCloud c = someCloud(5);
  GaussianModel m(c);
  m.updateFilter(std::vector<Camera>{cameraInFront()}, 1.0f);
  m.activate();
  for (std::size_t i = 0; i < c.size(); ++i) {
    double before = c.opacity[i], after = m.physical().plane(L::kOpacity)[i];
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(m.physical().plane(L::kScale + k)[i], c.scale_m[i][k]);
      before *= c.scale_m[i][k];
      after *= m.physical().plane(L::kScale + k)[i];
    }
    EXPECT_NEAR(after / before, 1, 1e-4);
  }
}

TEST(GaussianModel, UnbakingAFilterGivesThePhysicalValuesBack) {
  const std::vector<Camera> cameras{cameraInFront()};
  GaussianModel m(someCloud(5));
  m.updateFilter(cameras, 0.3f);
  const GaussianCloud baked = m.cloud();
  GaussianModel again(baked);
  again.takeFilterOut(cameras, 0.3f);
  again.activate();
  for (std::size_t i = 0; i < baked.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(again.physical().plane(L::kScale + k)[i] / baked.scale_m[i][k], 1, 1e-3);
    }
    EXPECT_NEAR(again.physical().plane(L::kOpacity)[i], baked.opacity[i], 1e-3);
  }
}

TEST(GaussianModel, ChainsGradientsToLogScaleAndLogitAsCentralDifferencesDo) {
  const std::vector<Camera> cameras{cameraInFront()};
  const GaussianCloud c = someCloud(4);
  GaussianModel m(c);
  m.updateFilter(cameras, 1.0f);
  m.activate();
  GaussianBuffers gradient(c.size());
  gradient.plane(L::kScale)[1] = 0.7f;
  gradient.plane(L::kScale + 2)[1] = -1.3f;
  gradient.plane(L::kOpacity)[1] = 0.4f;
  RecordingOps ops;
  m.step(gradient, kRates, 3, {}, 1, ops);
  const double h = 1e-3;
  for (int k = 0; k < 3; ++k) {
    GaussianCloud up = c, down = c;
    up.scale_m[1][k] *= static_cast<float>(std::exp(h));
    down.scale_m[1][k] *= static_cast<float>(std::exp(-h));
    const double expected = (score(up, 1.0f, cameras) - score(down, 1.0f, cameras)) / (2 * h);
    EXPECT_NEAR(ops.seen.plane(L::kScale + k)[1], expected, 2e-4) << "axis " << k;
  }
  const auto moved = [&](double by) {
    GaussianCloud d = c;
    const double l = std::log(d.opacity[1] / (1 - d.opacity[1])) + by;
    d.opacity[1] = static_cast<float>(1 / (1 + std::exp(-l)));
    return d;
  };
  const double expected = (score(moved(h), 1.0f, cameras) - score(moved(-h), 1.0f, cameras)) / (2 * h);
  EXPECT_NEAR(ops.seen.plane(L::kOpacity)[1], expected, 2e-4);
}

// The shape terms as their header states them, with the mean scale `m` held: it passes no gradient.
double shapeEnergy(const GaussianCloud& cloud, const Regularizers& r, double m) {
  double isotropy = 0, size = 0;
  for (const vec3& s : cloud.scale_m) {
    const double high = std::max({s.x, s.y, s.z}), low = std::min({s.x, s.y, s.z});
    isotropy += std::max(high / low, 4.0) / static_cast<double>(cloud.size());
    size += std::max(0.0, high - 5 * m) + std::max(0.0, m / 5 - high);
  }
  return r.isotropy * isotropy + r.size * size;
}

TEST(GaussianModel, ShapeTermsHaveTheGradientOfTheirEnergies) {
  GaussianCloud c = someCloud(12);
  c.scale_m[3] = vec3(0.0003f, 0.0002f, 0.00025f);  // under a fifth of the mean
  c.scale_m[5] = vec3(0.004f, 0.05f, 0.005f);       // over five means, and long
  double m = 0;
  for (const vec3& s : c.scale_m) m += (s.x + s.y + s.z) / 36.0;
  const Regularizers shape{.isotropy = 0.3f, .size = 2};
  GaussianModel model(c);
  GaussianBuffers gradient(c.size());
  RecordingOps ops;
  model.activate();
  model.step(gradient, kRates, 3, shape, 1, ops);
  const double h = 1e-3;
  for (const std::size_t i : {std::size_t{1}, std::size_t{3}, std::size_t{5}}) {
    for (int k = 0; k < 3; ++k) {
      GaussianCloud up = c, down = c;
      up.scale_m[i][k] *= static_cast<float>(std::exp(h));
      down.scale_m[i][k] *= static_cast<float>(std::exp(-h));
      const double expected = (shapeEnergy(up, shape, m) - shapeEnergy(down, shape, m)) / (2 * h);
      EXPECT_NEAR(ops.seen.plane(L::kScale + k)[i], expected, 1e-3 * std::abs(expected) + 1e-6)
          << "Gaussian " << i << " axis " << k;
    }
  }
}

TEST(GaussianModel, TheTemporalTermHasTheGradientOfItsEnergyAndNoneAtTheReference) {
  const GaussianCloud c = someCloud(6);
  GaussianModel model(c);
  model.keepReference();
  const Regularizers steady{.temporal = 0.7f, .temporal_shape = 0.5f};
  RecordingOps ops;
  GaussianBuffers none(c.size());
  model.activate();
  model.step(none, kRates, 3, steady, 1, ops);
  for (int p = L::kScale; p < L::kExtra; ++p) EXPECT_EQ(ops.seen.plane(p)[2], 0) << p;
  EXPECT_EQ(model.temporalEnergy(0.5f), 0);

  GaussianCloud other = c;
  other.color.of(2)[5] += 0.25f;
  other.scale_m[2].y *= std::exp(0.5f);
  model.takeAppearance(GaussianModel(other));
  EXPECT_NEAR(model.temporalEnergy(0.5f), 0.25 * 0.25 + 0.5 * 0.5 * 0.5, 1e-5);
  GaussianBuffers gradient(c.size());
  model.activate();
  model.step(gradient, kRates, 3, steady, 2, ops);
  EXPECT_NEAR(ops.seen.plane(L::kSh + 5)[2], 2 * 0.7 * 0.25, 1e-5);
  EXPECT_NEAR(ops.seen.plane(L::kScale + 1)[2], 2 * 0.7 * 0.5 * 0.5, 1e-5);
  EXPECT_EQ(ops.seen.plane(L::kSh + 5)[3], 0);
}

TEST(Relocation, OneCopyChangesNothing) {
  const Relocation r = relocation(0.5f, 1);
  EXPECT_NEAR(r.opacity, 0.5f, 1e-6f);
  EXPECT_NEAR(r.scale, 1.0f, 1e-6f);
}

TEST(Relocation, TwoCopiesOfOneHalfTakeTheKnownValues) {
  const Relocation r = relocation(0.5f, 2);
  EXPECT_NEAR(r.opacity, 0.29289f, 1e-5f);
  EXPECT_NEAR(r.scale, 0.9522f, 1e-4f);
}

TEST(Mcmc, GrowthStopsAtTheCapAndKeepsEverythingFinite) {
  GaussianModel m(someCloud(100));
  EXPECT_EQ(grow(m, 1.5, 120, 1, 1), 20u);
  EXPECT_EQ(m.size(), 120u);
  EXPECT_EQ(grow(m, 1.5, 120, 1, 2), 0u);
  EXPECT_NO_THROW(validate(m.cloud()));
}

TEST(Mcmc, DeadGaussiansMoveOntoLivingOnes) {
  GaussianCloud c = someCloud(10);
  c.opacity[3] = 0.001f;
  GaussianModel m(c);
  EXPECT_EQ(relocateDead(m, 1, 7), 1u);
  EXPECT_GT(m.opacity(3), 0.004f);
  EXPECT_NE(m.cloud().position_m[3], c.position_m[3]);
}

TEST(Mcmc, NoiseMovesOnlyNearlyTransparentGaussians) {
  GaussianCloud c = someCloud(4);
  c.opacity[2] = 0.002f;
  GaussianModel m(c);
  m.addNoise(100.0f, 1, 3);
  const GaussianCloud after = m.cloud();
  EXPECT_EQ(after.position_m[3], c.position_m[3]);
  EXPECT_NE(after.position_m[2], c.position_m[2]);
}

TEST(GaussianModel, KeepDropsTheOthers) {
  const GaussianCloud c = someCloud(5);
  GaussianModel m(c);
  const std::vector<std::uint8_t> flags{1, 0, 0, 1, 1};
  m.keep(flags);
  ASSERT_EQ(m.size(), 3u);
  EXPECT_EQ(m.cloud().position_m[1], c.position_m[3]);
  EXPECT_NEAR(m.cloud().opacity[2], c.opacity[4], 1e-6f);
}

}  // namespace
}  // namespace beam
