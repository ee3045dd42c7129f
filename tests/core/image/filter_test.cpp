// SPDX-License-Identifier: Apache-2.0
// The depth that is evened out along a surface. (The denoiser and depth edges: tests/core/method.)
#include "core/image/filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/rng.h"

namespace beam {
namespace {

constexpr int kSize = 21, kMiddle = 10, kRadius = 4;

struct Surface {
  Image<float> depth_m{kSize, kSize, 2.0f};
  Image<float> alpha{kSize, kSize, 1.0f};
  Image<vec3> normal{kSize, kSize, vec3(0, 0, -1)};

  float even(int x = kMiddle, int y = kMiddle, int radius = kRadius) const {
    return evenDepth({depth_m, alpha, normal}, x, y, radius);
  }
  // Calls change(x, y) for the pixels right of the middle.
  template <class Change>
  void right(Change&& change) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = kMiddle + 1; x < kSize; ++x) change(x, y);
    }
  }
};

TEST(EvenDepth, LeavesAConstantAndTheMiddleOfASlopeAsTheyAre) {
  Surface s;
  EXPECT_FLOAT_EQ(s.even(), 2);
  EXPECT_FLOAT_EQ(s.even(0, 0), 2);
  EXPECT_FLOAT_EQ(s.even(kSize - 1, 3), 2);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x)
      s.depth_m(x, y) = 2 + 0.002f * static_cast<float>(x) - 0.001f * static_cast<float>(y);
  }
  EXPECT_NEAR(s.even(), s.depth_m(kMiddle, kMiddle), 1e-5);
}

TEST(EvenDepth, TakesMostOfTheStepsBetweenGaussians) {
  Surface s;
  const RandomStream random(1);
  for (std::size_t i = 0; i < s.depth_m.pixels.size(); ++i) s.depth_m.pixels[i] += 0.004f * random.normal(i);
  double before = 0, after = 0;
  for (int y = kRadius; y < kSize - kRadius; ++y) {
    for (int x = kRadius; x < kSize - kRadius; ++x) {
      before += std::pow(s.depth_m(x, y) - 2, 2);
      after += std::pow(s.even(x, y) - 2, 2);
    }
  }
  EXPECT_LT(after, before / 16);
}

TEST(EvenDepth, TakesNothingFromWhatIsMoreThanThreeCentimetresAway) {
  Surface s;
  s.right([&](int x, int y) { s.depth_m(x, y) = 2.031f; });
  EXPECT_FLOAT_EQ(s.even(), 2);
  s.right([&](int x, int y) { s.depth_m(x, y) = 2.029f; });
  EXPECT_GT(s.even(), 2.005f);
}

TEST(EvenDepth, TakesNothingFromWhatFacesElsewhereOrIsHardlyCovered) {
  Surface s;
  s.right([&](int x, int y) {
    s.depth_m(x, y) = 2.02f;
    s.normal(x, y) = vec3(1, 0, 0);
  });
  EXPECT_FLOAT_EQ(s.even(), 2);
  s.right([&](int x, int y) {
    s.normal(x, y) = vec3(0, 0, -1);
    s.alpha(x, y) = 0.9f;
  });
  EXPECT_FLOAT_EQ(s.even(), 2);
}

TEST(EvenDepth, LooksNoFurtherThanItsRadius) {
  Surface s;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      if (std::max(std::abs(x - kMiddle), std::abs(y - kMiddle)) > kRadius) s.depth_m(x, y) = 2.02f;
    }
  }
  EXPECT_FLOAT_EQ(s.even(), 2);
  EXPECT_GT(s.even(kMiddle, kMiddle, kRadius + 1), 2.0001f);
}

TEST(EvenDepth, KeepsNothingWhereThereIsNoDepth) {
  Surface s;
  s.depth_m(kMiddle, kMiddle) = 0;
  s.alpha(kMiddle, kMiddle) = 0.3f;
  EXPECT_EQ(s.even(), 0);
}

}  // namespace
}  // namespace beam
