// SPDX-License-Identifier: Apache-2.0
// Laws of E_normal: zero where blended normals agree with the depth, and its gradient.
#include "core/optim/normal_loss.h"

#include <gtest/gtest.h>

#include <cmath>

namespace beam {
namespace {

constexpr int kWidth = 9, kHeight = 8;
const Intrinsics kIntrinsics{20, 21, 4.2, 3.9};

// A smooth bumpy surface with normals that are a little off.
RasterImages bumpy() {
  RasterImages r;
  r.alpha = Planes(kWidth, kHeight, 1);
  r.depth = Planes(kWidth, kHeight, 1);
  r.median_depth = Planes(kWidth, kHeight, 1);
  r.normal = Planes(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int p = y * kWidth + x;
      r.alpha.values[p] = 0.9f;
      r.depth.values[p] = 2 + 0.004f * std::sin(0.9f * x) + 0.003f * std::cos(1.1f * y);
      r.median_depth.values[p] = 2 + 0.004f * std::cos(0.7f * x) - 0.003f * y;
      r.normal.plane(0)[p] = 0.2f * std::sin(0.5f * x);
      r.normal.plane(1)[p] = 0.1f;
      r.normal.plane(2)[p] = -0.85f;
    }
  }
  return r;
}

double lossOf(const RasterImages& r) {
  RasterImages upstream;
  return normalLoss(r, kIntrinsics, {.weight = 0.5f}, upstream);
}

void expectGradient(Planes RasterImages::*which, float h) {
  RasterImages images = bumpy(), upstream;
  normalLoss(images, kIntrinsics, {.weight = 0.5f}, upstream);
  for (std::size_t i = 0; i < (images.*which).values.size(); ++i) {
    float& v = (images.*which).values[i];
    const float keep = v;
    v = keep + h;
    const double up = lossOf(images);
    v = keep - h;
    const double down = lossOf(images);
    v = keep;
    EXPECT_NEAR((upstream.*which).values[i], (up - down) / (2.0 * h),
                2e-3 * (1 + std::abs(up - down) / (2 * h)))
        << "value " << i;
  }
}

TEST(NormalLoss, IsZeroWhereTheBlendedNormalIsTheDepthsNormal) {
  RasterImages r = bumpy();
  r.median_depth = r.depth;
  const Planes n = normalsFromDepth(r.depth, r.alpha, kIntrinsics);
  for (std::size_t i = 0; i < n.values.size(); ++i) r.normal.values[i] = 0.9f * n.values[i];
  EXPECT_NEAR(lossOf(r), 0, 1e-6);
}

TEST(NormalLoss, NormalsOfAFrontalPlaneFaceTheCamera) {
  Planes depth(kWidth, kHeight, 1, 1.5f), alpha(kWidth, kHeight, 1, 1.0f);
  const Planes n = normalsFromDepth(depth, alpha, kIntrinsics);
  EXPECT_NEAR(n.plane(2)[3 * kWidth + 4], -1, 1e-5);
}

TEST(NormalLoss, DepthEdgesDoNotCount) {
  Planes depth(kWidth, kHeight, 1, 1.5f), alpha(kWidth, kHeight, 1, 1.0f);
  for (int y = 0; y < kHeight; ++y) depth.values[y * kWidth + 5] = 1.0f;
  const Planes n = normalsFromDepth(depth, alpha, kIntrinsics);
  EXPECT_EQ(n.plane(2)[3 * kWidth + 4], 0);
  EXPECT_NEAR(n.plane(2)[3 * kWidth + 2], -1, 1e-5);
}

TEST(NormalLoss, GradientOfTheNormalsMatchesCentralDifferences) {
  expectGradient(&RasterImages::normal, 1e-2f);
}
TEST(NormalLoss, GradientOfTheCoverageMatchesCentralDifferences) {
  expectGradient(&RasterImages::alpha, 1e-2f);
}
TEST(NormalLoss, GradientOfTheExpectedDepthMatchesCentralDifferences) {
  expectGradient(&RasterImages::depth, 1e-3f);
}
TEST(NormalLoss, GradientOfTheMedianDepthMatchesCentralDifferences) {
  expectGradient(&RasterImages::median_depth, 1e-3f);
}

}  // namespace
}  // namespace beam
