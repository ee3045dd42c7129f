// SPDX-License-Identifier: Apache-2.0
// Laws of the loss of a view: the gradient that it hands out before `backward` is that of its value, and what
// stands between the Gaussians and the photograph learns from it.
#include "core/method/view_loss.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/rng.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam {
namespace {

using testing::SphereCapture;

const SphereCapture kSphere{.cameras = 4, .size_px = 40};
constexpr ViewLossOptions kOptions{.mask_weight = 0.3, .normal_weight = 0.1};

// A ball of another size and colour than that of the photographs: every pixel differs.
GaussianBuffers otherBall() {
  GaussianCloud cloud;
  testing::addSphere(cloud, kSphere.center, 0.24f, 150);
  const RandomStream random(7);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.opacity[i] = 0.3f;
    for (int c = 0; c < 3; ++c) cloud.color.of(i)[c] = 2 * random.uniform(3 * i + c) - 1;
  }
  return toBuffers(cloud);
}

struct Bench {
  std::unique_ptr<ComputeDevice> device = makeCpuDevice();
  GaussianBuffers ball = otherBall();
  ViewLoss loss;
  ViewDraw what;
  explicit Bench(bool geometry)
      : loss(testing::photographs(kSphere), kOptions, geometry, *device), what(loss.drawOf(3)) {
    loss.draw(ball, what, 3);
    for (int round = 0; round < 2; ++round) loss.compare();  // the second owes nothing to the first
  }
};

// dL/d(plane) where the ball is, against differences of the loss, where those of both sides agree: L1, the
// mask and the edges of depth have kinks.
void expectGradient(Planes RasterImages::*which, float h) {
  Bench b(true);
  const Planes gradient = b.loss.upstream().*which, alpha = b.loss.images().alpha;
  ASSERT_EQ(gradient.values.size(), (b.loss.images().*which).values.size());
  const double middle = b.loss.compare().total();
  double largest = 0;
  for (const float g : gradient.values) largest = std::max(largest, std::abs(static_cast<double>(g)));
  ASSERT_GT(largest, 0);
  int covered = 0, smooth = 0;
  for (std::size_t i = 0; i < gradient.values.size(); ++i) {
    if (alpha.values[i % alpha.planeSize()] < 0.2f) continue;
    ++covered;
    float& value = (b.loss.images().*which).values[i];
    const float keep = value;
    value = keep + h;
    const double up = (b.loss.compare().total() - middle) / h;
    value = keep - h;
    const double down = (middle - b.loss.compare().total()) / h;
    value = keep;
    if (std::abs(up - down) > 0.02 * largest) continue;
    ++smooth;
    EXPECT_NEAR(gradient.values[i], (up + down) / 2, 0.02 * largest) << "value " << i;
  }
  EXPECT_GT(covered, 80);
  EXPECT_GT(2 * smooth, covered);
}

TEST(ViewLoss, TheGradientOfThePictureIsThatOfTheLoss) { expectGradient(&RasterImages::color, 2e-3f); }
TEST(ViewLoss, TheGradientOfTheCoverageIsThatOfTheLoss) { expectGradient(&RasterImages::alpha, 1e-3f); }
TEST(ViewLoss, TheGradientOfTheNormalsIsThatOfTheLoss) { expectGradient(&RasterImages::normal, 1e-2f); }
TEST(ViewLoss, TheGradientOfTheDepthIsThatOfTheLoss) { expectGradient(&RasterImages::depth, 1e-4f); }

// A colour matrix of the camera between the Gaussians and the photograph.
struct Graded {
  Bench bench{false};
  dmat3 matrix{1.05, 0.04, -0.03, 0.02, 0.9, 0.05, -0.04, 0.03, 0.95};  // by columns
  Planes drawn;

  double value() {
    bench.loss.draw(bench.ball, bench.what, 3);
    drawn = bench.loss.images().color;
    apply(matrix, drawn, bench.loss.images().color);
    return bench.loss.compare().total();
  }
  static void apply(const dmat3& m, const Planes& in, Planes& out) {
    for (std::size_t i = 0; i < in.planeSize(); ++i) {
      const dvec3 c = m * dvec3(in.plane(0)[i], in.plane(1)[i], in.plane(2)[i]);
      for (int k = 0; k < 3; ++k) out.plane(k)[i] = static_cast<float>(c[k]);
    }
  }
  double slopeAlong(auto& number, double h) {
    const auto keep = number;
    number = static_cast<std::remove_reference_t<decltype(number)>>(keep + h);
    const double up = value();
    number = static_cast<std::remove_reference_t<decltype(number)>>(keep - h);
    const double down = value();
    number = keep;
    return (up - down) / (2 * h);
  }
};

TEST(ViewLoss, AColourMatrixLearnsFromThePicturesGradient) {
  Graded g;
  g.value();
  const Planes upstream = g.bench.loss.upstream().color, drawn = g.drawn;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      double gradient = 0;
      for (std::size_t i = 0; i < drawn.planeSize(); ++i) {
        gradient += static_cast<double>(upstream.plane(row)[i]) * drawn.plane(column)[i];
      }
      EXPECT_NEAR(gradient, g.slopeAlong(g.matrix[column][row], 1e-3), 2e-3) << row << column;
    }
  }
}

TEST(ViewLoss, TheGaussiansBehindAColourMatrixLearnThroughIt) {
  Graded g;
  g.value();
  GaussianBuffers gradients;
  Planes& upstream = g.bench.loss.upstream().color;
  Graded::apply(glm::transpose(g.matrix), Planes(upstream), upstream);
  g.bench.loss.backward(gradients);
  const float* of_red = gradients.plane(PlaneLayout::kSh);
  const std::size_t strongest = std::max_element(of_red, of_red + gradients.count,
                                                 [](float a, float b) { return std::abs(a) < std::abs(b); }) -
                                of_red;
  const double expected = g.slopeAlong(g.bench.ball.plane(PlaneLayout::kSh)[strongest], 0.01);
  EXPECT_NEAR(of_red[strongest], expected, 0.03 * std::abs(expected));
}

TEST(ViewLoss, AViewWithoutAMaskStandsOnBlackAndIsNotPulledToOne) {
  auto views = testing::photographs(kSphere);
  for (FrameView& v : views) v.mask = {};
  const auto device = makeCpuDevice();
  const GaussianBuffers ball = otherBall();
  ViewLoss loss(views, kOptions, false, *device);
  loss.draw(ball, {.view = 1, .background = vec3(1)}, 3);
  const Planes on_white = loss.images().color;
  const PictureLoss of_white = loss.compare();
  loss.draw(ball, {.view = 1}, 3);
  EXPECT_EQ(on_white.values, loss.images().color.values);
  EXPECT_EQ(of_white.photometric, loss.compare().photometric);
  EXPECT_EQ(of_white.mask, 0);
}

TEST(ViewLoss, AnEpochSeesEveryViewOnceEachOnABackgroundOfItsOwn) {
  const Bench b(false);
  std::vector<int> seen(b.loss.size());
  for (int step = 0; step < static_cast<int>(seen.size()); ++step) {
    ++seen[b.loss.drawOf(step).view];
    EXPECT_NE(b.loss.drawOf(step).background, b.loss.drawOf(step + 1).background);
    EXPECT_NE(b.loss.drawOf(step).background, b.loss.drawOf(step, 1).background);
  }
  EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
}

}  // namespace
}  // namespace beam
