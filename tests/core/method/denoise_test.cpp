// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/image/filter.h"

namespace beam {
namespace {

constexpr int kSize = 64;

DenoiseGuides flatGuides() {
  return {Image<vec3>(kSize, kSize, vec3(0, 0, 1)), Image<float>(kSize, kSize, 2.0f),
          Image<std::uint8_t>(kSize, kSize, 1)};
}

NoisySignal noisy(float left, float right, float sigma, int channels = 1) {
  NoisySignal s{Planes(kSize, kSize, channels), Planes(kSize, kSize, 1, sigma * sigma)};
  const RandomStream random(11);
  for (int c = 0; c < channels; ++c) {
    for (int i = 0; i < kSize * kSize; ++i) {
      s.values.plane(c)[i] = (i % kSize < kSize / 2 ? left : right) + sigma * random.normal(i + c * 100000);
    }
  }
  return s;
}

double rmsError(const Planes& p, float left, float right, int margin = 0) {
  double sum = 0;
  int count = 0;
  for (int y = margin; y < kSize - margin; ++y) {
    for (int x = margin; x < kSize - margin; ++x) {
      sum += std::pow(p.values[y * kSize + x] - (x < kSize / 2 ? left : right), 2);
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

NoisySignal denoised(NoisySignal signal, const DenoiseGuides& guides, int levels = 5) {
  denoiseATrous({&signal, 1}, guides, levels);
  return signal;
}

TEST(Denoise, LeavesAConstantAsItIs) {
  const NoisySignal out = denoised(noisy(0.7f, 0.7f, 0, 3), flatGuides());
  for (const float v : out.values.values) EXPECT_NEAR(v, 0.7f, 1e-6);
}

TEST(Denoise, TakesMostOfTheNoiseAndKeepsTheMean) {
  const NoisySignal out = denoised(noisy(0.5f, 0.5f, 0.1f), flatGuides());
  EXPECT_LT(rmsError(out.values, 0.5f, 0.5f), 0.012);
}

TEST(Denoise, KeepsAnEdgeThatTheNormalsShow) {
  DenoiseGuides guides = flatGuides();
  for (int y = 0; y < kSize; ++y) {
    for (int x = kSize / 2; x < kSize; ++x) guides.normal(x, y) = glm::normalize(vec3(1, 0, 1));
  }
  const NoisySignal out = denoised(noisy(0.4f, 0.6f, 0.1f), guides);
  EXPECT_LT(rmsError(out.values, 0.4f, 0.6f), 0.015);
}

TEST(Denoise, KeepsAnEdgeThatTheDepthShows) {
  DenoiseGuides guides = flatGuides();
  for (int y = 0; y < kSize; ++y) {
    for (int x = kSize / 2; x < kSize; ++x) guides.depth_m(x, y) = 2.2f;
  }
  const NoisySignal out = denoised(noisy(0.4f, 0.6f, 0.1f), guides);
  EXPECT_LT(rmsError(out.values, 0.4f, 0.6f), 0.015);
}

TEST(Denoise, KeepsAStrongEdgeOfTheSignalItself) {
  const NoisySignal out = denoised(noisy(0.1f, 0.9f, 0.02f), flatGuides());
  EXPECT_LT(rmsError(out.values, 0.1f, 0.9f), 0.01);
}

TEST(Denoise, FiltersAcrossASlantedPlane) {
  DenoiseGuides guides = flatGuides();
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) guides.depth_m(x, y) = 2.0f + 0.01f * x;  // 10 mm a pixel
  }
  EXPECT_LT(rmsError(denoised(noisy(0.5f, 0.5f, 0.1f), guides).values, 0.5f, 0.5f), 0.02);
}

TEST(Denoise, NeverPullsFromOutsideTheMask) {
  DenoiseGuides guides = flatGuides();
  NoisySignal signal = noisy(0.5f, 0.5f, 0.0f);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; x += 3) {
      guides.valid(x, y) = 0;
      signal.values.values[y * kSize + x] = 1e6f;
    }
  }
  const NoisySignal out = denoised(signal, guides);
  for (int i = 0; i < kSize * kSize; ++i) {
    EXPECT_NEAR(out.values.values[i], guides.valid.pixels[i] ? 0.5f : 1e6f, 1e-5);
  }
}

TEST(Denoise, IsTheSameForOneAndTwoThreads) {
  setThreadCount(1);
  const NoisySignal one = denoised(noisy(0.4f, 0.6f, 0.1f, 3), flatGuides());
  setThreadCount(2);
  const NoisySignal two = denoised(noisy(0.4f, 0.6f, 0.1f, 3), flatGuides());
  setThreadCount(0);
  EXPECT_EQ(one.values.values, two.values.values);
}

TEST(DepthEdges, AreAtStepsHolesAndBordersOnly) {
  Image<float> depth(32, 32, 2.0f), alpha(32, 32, 1.0f);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) depth(x, y) = (x < 16 ? 2.0f : 2.1f) + 0.012f * y;
  }
  alpha(5, 20) = 0.2f;
  const Image<std::uint8_t> edges = depthEdges(depth, alpha);
  EXPECT_FALSE(edges(8, 10));
  EXPECT_FALSE(edges(24, 10));
  EXPECT_TRUE(edges(15, 10));
  EXPECT_TRUE(edges(16, 10));
  EXPECT_TRUE(edges(4, 20));
  EXPECT_TRUE(edges(0, 10));
}

TEST(DepthEdges, LetSteepPlanesPass) {
  Image<float> depth(16, 16), alpha(16, 16, 1.0f);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) depth(x, y) = 1.0f + 0.05f * x + 0.05f * y;
  }
  EXPECT_FALSE(depthEdges(depth, alpha)(8, 8));
}

}  // namespace
}  // namespace beam
