// SPDX-License-Identifier: Apache-2.0
// The photometric loss and Adam: values against slow forms, gradients against central differences, the same
// bits from every instruction set and thread count.
#include "core/render/training_ops.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/render/device.h"

namespace beam {
namespace {

Planes noise(int w, int h, std::uint64_t seed) {
  Planes p(w, h, 3);
  const RandomStream r(seed);
  for (std::size_t i = 0; i < p.values.size(); ++i) {
    p.values[i] = 0.5f + 0.3f * std::sin(0.07f * static_cast<float>(i)) + 0.2f * (r.uniform(i) - 0.5f);
  }
  return p;
}

// Direct double form, zero padding (methods 1.10).
double slowSsim(const Planes& a, const Planes& b) {
  std::array<double, 11> k{};
  double norm = 0;
  for (int i = 0; i < 11; ++i) norm += k[i] = std::exp(-(i - 5) * (i - 5) / 4.5);
  double total = 0;
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < a.height; ++y) {
      for (int x = 0; x < a.width; ++x) {
        double m[5] = {};
        for (int j = 0; j < 11; ++j) {
          for (int i = 0; i < 11; ++i) {
            const int u = x + i - 5, v = y + j - 5;
            if (u < 0 || v < 0 || u >= a.width || v >= a.height) continue;
            const double w = k[i] * k[j] / (norm * norm);
            const double p = a.plane(c)[v * a.width + u], q = b.plane(c)[v * a.width + u];
            m[0] += w * p, m[1] += w * q, m[2] += w * p * p, m[3] += w * q * q, m[4] += w * p * q;
          }
        }
        const double c1 = 1e-4, c2 = 9e-4;
        total += (2 * m[0] * m[1] + c1) * (2 * (m[4] - m[0] * m[1]) + c2) /
                 ((m[0] * m[0] + m[1] * m[1] + c1) * (m[2] - m[0] * m[0] + m[3] - m[1] * m[1] + c2));
      }
    }
  }
  return total / (3.0 * a.width * a.height);
}

TEST(Photometric, OfAPictureWithItselfIsZeroAndFlat) {
  const Planes a = noise(37, 21, 1);
  Planes g;
  const PhotometricLoss loss = makeCpuDevice()->newTrainingOps()->photometric(a, a, 0.2f, g);
  EXPECT_NEAR(loss.ssim, 1, 1e-7);
  EXPECT_EQ(loss.l1, 0);
  for (const float v : g.values) EXPECT_NEAR(v, 0, 1e-7);
}

constexpr int kTall = 110;  // more than one band of rows

double slowL1(const Planes& a, const Planes& b) {
  double l1 = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) l1 += std::abs(a.values[i] - b.values[i]);
  return l1 / static_cast<double>(a.values.size());
}

TEST(Photometric, IsTheSlowForm) {
  for (const ivec2& size : {ivec2(37, kTall), ivec2(16, 5), ivec2(3, 21)}) {
    const Planes a = noise(size.x, size.y, 1), b = noise(size.x, size.y, 2);
    Planes g;
    const PhotometricLoss loss = makeCpuDevice()->newTrainingOps()->photometric(a, b, 0.2f, g);
    EXPECT_NEAR(loss.ssim, slowSsim(a, b), 1e-5);
    EXPECT_NEAR(loss.l1, slowL1(a, b), 1e-6);
    EXPECT_NEAR(loss.total, 0.8 * loss.l1 + 0.2 * (1 - loss.ssim), 1e-6);
  }
}

// Corners, band borders, and the middle of each channel.
TEST(Photometric, GradientMatchesCentralDifferences) {
  Planes a = noise(20, kTall, 3);
  const Planes b = noise(20, kTall, 4);
  const auto ops = makeCpuDevice()->newTrainingOps();
  Planes g;
  ops->photometric(a, b, 0.7f, g);
  for (const ivec3& at : {ivec3(0, 0, 0), ivec3(19, 0, 1), ivec3(7, 50, 2), ivec3(3, 90, 0), ivec3(15, 95, 1),
                          ivec3(8, 96, 2), ivec3(19, 101, 0), ivec3(0, 109, 1)}) {
    const std::size_t i = (static_cast<std::size_t>(at.z) * kTall + at.y) * 20 + at.x;
    const float keep = a.values[i], h = 2e-3f;
    const auto lossAt = [&](float v) {
      a.values[i] = v;
      return 0.3 * slowL1(a, b) + 0.7 * (1 - slowSsim(a, b));
    };
    const double expected = (lossAt(keep + h) - lossAt(keep - h)) / (2.0 * h);
    a.values[i] = keep;
    EXPECT_NEAR(g.values[i], expected, 1e-2 * std::abs(expected) + 5e-7)
        << at.x << " " << at.y << " " << at.z;
  }
}

TEST(Photometric, PullsEqualPixelsNowhereByL1) {
  const Planes a(20, 20, 3, 0.25f);
  Planes b = a, g;
  b.values[5] = 0.5f, b.values[6] = 0.125f;
  makeCpuDevice()->newTrainingOps()->photometric(a, b, 0, g);
  for (std::size_t i = 0; i < g.values.size(); ++i)
    EXPECT_EQ(g.values[i], (i == 5 ? -1.0f : i == 6 ? 1.0f : 0.0f) / 1200);
}

TEST(Photometric, RefusesPicturesOfDifferentSize) {
  Planes g;
  EXPECT_THROW(makeCpuDevice()->newTrainingOps()->photometric(Planes(8, 9, 3), Planes(9, 8, 3), 0.2f, g),
               Error);
}

GaussianBuffers filled(std::size_t n, std::uint64_t seed, float size) {
  GaussianBuffers b(n);
  const RandomStream r(seed);
  for (int p = 0; p < b.planes(); ++p) {
    for (std::size_t i = 0; i < n; ++i) b.plane(p)[i] = size * (r.uniform(p * n + i) - 0.5f);
  }
  return b;
}

TEST(Adam, FirstStepMovesByTheRateAgainstTheSignAndARateOfZeroMovesNothing) {
  GaussianBuffers p = filled(40, 1, 1), g = filled(40, 2, 1e-3f), m(40), v(40);
  const GaussianBuffers before = p;
  std::vector<AdamPlane> planes(p.planes(), {0.01f});
  planes[5].learning_rate = 0;
  makeCpuDevice()->newTrainingOps()->adam(p, g, m, v, planes, {}, 1);
  for (int k = 0; k < p.planes(); ++k) {
    for (std::size_t i = 0; i < 40; ++i) {
      const float moved = p.plane(k)[i] - before.plane(k)[i];
      EXPECT_NEAR(moved, k == 5 ? 0 : g.plane(k)[i] > 0 ? -0.01f : 0.01f, 1e-5);
    }
  }
  EXPECT_EQ(m.plane(5)[3], 0);
}

TEST(Adam, ZeroGradientsMoveNothing) {
  GaussianBuffers p = filled(20, 1, 1), g(20), m(20), v(20);
  const GaussianBuffers before = p;
  const std::vector<AdamPlane> planes(p.planes(), {0.01f});
  for (int step = 1; step < 4; ++step) makeCpuDevice()->newTrainingOps()->adam(p, g, m, v, planes, {}, step);
  EXPECT_EQ(p.values, before.values);
}

TEST(Adam, FollowsTheRecurrenceInDouble) {
  GaussianBuffers p = filled(40, 1, 1), m(40), v(40);
  const std::vector<AdamPlane> planes(p.planes(), {0.01f});
  std::vector<double> x(p.values.begin(), p.values.end()), first(x.size()), second(x.size());
  for (int step = 1; step <= 20; ++step) {
    const GaussianBuffers g = filled(40, 100 + step, 1e-3f);
    makeCpuDevice()->newTrainingOps()->adam(p, g, m, v, planes, {}, step);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double d = g.values[i];
      first[i] = 0.9 * first[i] + 0.1 * d;
      second[i] = 0.999 * second[i] + 0.001 * d * d;
      x[i] -= 0.01 * first[i] / (1 - std::pow(0.9, step)) /
              (std::sqrt(second[i] / (1 - std::pow(0.999, step))) + 1e-15);
    }
  }
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(p.values[i], x[i], 2e-5) << i;
}

TEST(Adam, RefusesBuffersOfDifferentSize) {
  GaussianBuffers p(40), g(20), m(40), v(40);
  const std::vector<AdamPlane> planes(p.planes(), {0.01f});
  EXPECT_THROW(makeCpuDevice()->newTrainingOps()->adam(p, g, m, v, planes, {}, 1), Error);
}

std::vector<float> everything(SimdTarget target) {
  const auto ops = makeCpuDevice(target)->newTrainingOps();
  Planes g;
  const PhotometricLoss loss = ops->photometric(noise(53, 2 * kTall, 7), noise(53, 2 * kTall, 8), 0.2f, g);
  std::vector<float> all = g.values;
  for (const double d : {loss.l1, loss.ssim}) {
    all.push_back(static_cast<float>(d));
    all.push_back(static_cast<float>((d - all.back()) * 1e7));  // the lower digits
  }
  GaussianBuffers p = filled(1000, 3, 1), m(1000), v(1000);
  const std::vector<AdamPlane> planes(p.planes(), {0.01f});
  for (int step = 1; step < 5; ++step) ops->adam(p, filled(1000, 20 + step, 1e-3f), m, v, planes, {}, step);
  all.insert(all.end(), p.values.begin(), p.values.end());
  return all;
}

TEST(TrainingOps, EveryInstructionSetAndThreadCountGivesTheSameBits) {
  const std::vector<float> scalar = everything(SimdTarget::Scalar);
  for (const SimdTarget t : {SimdTarget::Avx2, SimdTarget::Avx512}) {
    try {
      EXPECT_EQ(everything(t), scalar);
    } catch (const std::exception& e) {
      std::cout << "skipped an instruction set: " << e.what() << "\n";
    }
  }
  setThreadCount(1);
  EXPECT_EQ(everything(SimdTarget::Auto), scalar);
  setThreadCount(0);
}

}  // namespace
}  // namespace beam
