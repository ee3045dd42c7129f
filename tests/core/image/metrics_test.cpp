// SPDX-License-Identifier: Apache-2.0
// Scores of pictures: identities, closed forms, and the slow form of what is filtered in bands.
#include "core/image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/rng.h"

namespace beam {
namespace {

Planes noise(int width, int height, int channels, std::uint64_t seed, float mean = 0.5f,
             float spread = 0.4f) {
  const RandomStream random(seed);
  Planes p(width, height, channels);
  for (std::size_t i = 0; i < p.values.size(); ++i) p.values[i] = mean + spread * (random.uniform(i) - 0.5f);
  return p;
}

PixelRect wholeOf(const Planes& p) { return {0, 0, p.width, p.height}; }

// Every window summed by itself, with the weights of the two-dimensional bell.
double slowSsim(const Planes& a, const Planes& b, PixelRect r) {
  double weight[11][11], total = 0;
  for (int j = 0; j < 11; ++j) {
    for (int i = 0; i < 11; ++i)
      total += weight[j][i] = std::exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / (2 * 1.5 * 1.5));
  }
  double sum = 0;
  int windows = 0;
  for (int c = 0; c < a.channels; ++c) {
    for (int y = r.y0; y + 11 <= r.y1; ++y) {
      for (int x = r.x0; x + 11 <= r.x1; ++x) {
        double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
        for (int j = 0; j < 11; ++j) {
          for (int i = 0; i < 11; ++i) {
            const std::size_t at = static_cast<std::size_t>(y + j) * a.width + x + i;
            const double u = a.plane(c)[at], v = b.plane(c)[at], w = weight[j][i] / total;
            ma += w * u;
            mb += w * v;
            aa += w * u * u;
            bb += w * v * v;
            ab += w * u * v;
          }
        }
        sum += (2 * ma * mb + 1e-4) * (2 * (ab - ma * mb) + 9e-4) /
               ((ma * ma + mb * mb + 1e-4) * (aa - ma * ma + bb - mb * mb + 9e-4));
        ++windows;
      }
    }
  }
  return sum / windows;
}

TEST(Psnr, OfEqualPicturesIs100AndOfAConstantErrorItsSize) {
  const Planes a = noise(20, 15, 3, 1);
  EXPECT_EQ(psnr(a, a, wholeOf(a)), 100);
  for (const float error : {0.1f, 0.01f, -0.05f}) {
    Planes b = a;
    for (float& v : b.values) v += error;
    EXPECT_NEAR(psnr(a, b, wholeOf(a)), -20 * std::log10(std::abs(error)), 1e-3);
  }
  Planes nearly = a;
  nearly.values[0] += 1e-6f;
  EXPECT_EQ(psnr(a, nearly, wholeOf(a)), 100) << "no more than of equal ones";
}

TEST(Psnr, AsksEveryChannelAndOnlyTheRectangle) {
  const Planes a(20, 10, 3, 0.5f);
  Planes b = a;
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 20; ++x) {
      if (x < 10) b.plane(1)[y * 20 + x] = 0.6f;
    }
  }
  EXPECT_NEAR(psnr(a, b, {0, 0, 10, 10}), 20 + 10 * std::log10(3.0), 1e-4) << "one of three";
  EXPECT_NEAR(psnr(a, b, {0, 0, 20, 10}), 20 + 10 * std::log10(6.0), 1e-4);
  EXPECT_EQ(psnr(a, b, {10, 0, 20, 10}), 100);
  EXPECT_EQ(psnr(a, b, {5, 2, 17, 8}), psnr(b, a, {5, 2, 17, 8}));
}

TEST(Ssim, OfAPictureWithItselfIsOneAndOfTwoTheSameBothWays) {
  const Planes a = noise(30, 24, 3, 2), b = noise(30, 24, 3, 3);
  EXPECT_NEAR(*ssim(a, a, wholeOf(a)), 1, 1e-12);
  EXPECT_EQ(ssim(a, b, wholeOf(a)), ssim(b, a, wholeOf(a)));
  EXPECT_LT(*ssim(a, b, wholeOf(a)), 0.2) << "they have nothing in common";
}

TEST(Ssim, OfTwoConstantsIsTheTermOfTheirBrightness) {
  const Planes a(16, 16, 1, 0.3f), b(16, 16, 1, 0.6f);
  EXPECT_NEAR(*ssim(a, b, wholeOf(a)), (2 * 0.3 * 0.6 + 1e-4) / (0.3 * 0.3 + 0.6 * 0.6 + 1e-4), 1e-6);
}

TEST(Ssim, OfAPictureWithItsNegativeIsNegative) {
  const Planes a = noise(24, 24, 1, 4);
  Planes negative = a;
  for (float& v : negative.values) v = 1 - v;
  EXPECT_LT(*ssim(a, negative, wholeOf(a)), -0.5);
}

TEST(Ssim, FallsAsNoiseGrows) {
  const Planes a = noise(40, 40, 1, 5), n = noise(40, 40, 1, 6, 0, 1);
  double last = 1;
  for (const float share : {0.05f, 0.1f, 0.2f, 0.4f}) {
    Planes b = a;
    for (std::size_t i = 0; i < b.values.size(); ++i) b.values[i] += share * n.values[i];
    const double now = *ssim(a, b, wholeOf(a));
    EXPECT_LT(now, last - 0.005);
    last = now;
  }
}

TEST(Ssim, IsTheSlowFormAlsoInMoreRowsThanABandAndInARectangle) {
  const Planes a = noise(17, 150, 2, 7);
  Planes b = noise(17, 150, 2, 8);
  for (std::size_t i = 0; i < b.values.size(); ++i) b.values[i] = 0.7f * a.values[i] + 0.3f * b.values[i];
  for (const PixelRect r : {PixelRect{0, 0, 17, 150}, PixelRect{0, 0, 17, 74}, PixelRect{0, 0, 17, 75},
                            PixelRect{3, 20, 15, 120}, PixelRect{6, 139, 17, 150}})
    EXPECT_NEAR(*ssim(a, b, r), slowSsim(a, b, r), 1e-12) << r.x0 << " " << r.y0 << " " << r.y1;
}

TEST(Ssim, OfARectangleThatHoldsNoWindowThereIsNone) {
  const Planes a = noise(30, 30, 3, 9);
  EXPECT_TRUE(ssim(a, a, {0, 0, 11, 11}));
  for (const PixelRect r : {PixelRect{0, 0, 10, 30}, PixelRect{0, 0, 30, 10}, PixelRect{5, 5, 6, 6}})
    EXPECT_FALSE(ssim(a, a, r)) << r.x1 << " " << r.y1;
}

TEST(MaskBounds, AreTheBoxOfWhatIsNotBlack) {
  Image<std::uint8_t> mask(60, 50, 0);
  mask(20, 10) = 1;
  mask(44, 37) = 255;
  const PixelRect r = maskBounds(mask);
  EXPECT_EQ(ivec2(r.x0, r.y0), ivec2(20, 10));
  EXPECT_EQ(ivec2(r.x1, r.y1), ivec2(45, 38));
}

TEST(MaskBounds, GrowToAWindowAtTheBordersOfThePicture) {
  for (const ivec2& at : {ivec2(0, 0), ivec2(59, 49), ivec2(59, 0), ivec2(0, 49)}) {
    Image<std::uint8_t> mask(60, 50, 0);
    mask(at.x, at.y) = 255;
    const PixelRect r = maskBounds(mask);
    EXPECT_EQ(ivec2(r.x0, r.y0), ivec2(at.x ? 49 : 0, at.y ? 39 : 0)) << at.x << " " << at.y;
    EXPECT_EQ(ivec2(r.x1, r.y1), ivec2(at.x ? 60 : 11, at.y ? 50 : 11)) << at.x << " " << at.y;
  }
}

TEST(MaskBounds, GrowToAWindowOnBothSidesOfASmallMask) {
  Image<std::uint8_t> mask(60, 50, 0);
  for (int y = 5; y < 45; ++y)
    for (const int x : {30, 31, 32}) mask(x, y) = 255;
  const PixelRect r = maskBounds(mask);
  EXPECT_EQ(ivec2(r.x0, r.x1), ivec2(26, 37));
  EXPECT_EQ(ivec2(r.y0, r.y1), ivec2(5, 45));
}

TEST(MaskBounds, StayInAPictureThatIsSmallerThanAWindow) {
  for (const ivec2& size : {ivec2(8, 40), ivec2(40, 8), ivec2(3, 2), ivec2(11, 11)}) {
    Image<std::uint8_t> mask(size.x, size.y, 0);
    mask(1, 1) = 255;
    const PixelRect r = maskBounds(mask);
    EXPECT_EQ(ivec2(r.x0, r.y0), ivec2(0, 0));
    EXPECT_EQ(ivec2(r.x1, r.y1), glm::min(size, ivec2(11))) << size.x << " x " << size.y;
  }
}

TEST(MaskBounds, OfNothingAreAnError) {
  try {
    maskBounds(Image<std::uint8_t>(20, 20, 0));
    FAIL() << "expected an error";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Data);
  }
}

}  // namespace
}  // namespace beam
