// SPDX-License-Identifier: Apache-2.0
// The rasteriser against the slow right answer: pictures, every gradient, geometry laws, and the same bits
// for any thread count and instruction set.
#include "core/render/rasterizer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/render/device.h"
#include "tests/support/message_of.h"
#include "tests/support/reference_raster.h"

namespace beam {
namespace {

using L = PlaneLayout;
using testing::ReferenceOptions;
using testing::ReferencePixel;
using testing::ReferenceRaster;

Camera offCentreCamera(int width, int height) {
  Camera c;
  c.width = width;
  c.height = height;
  c.intrinsics = {1.3 * width, 1.2 * width, 0.45 * width, 0.56 * height};
  c.camera_from_world.rotation = glm::normalize(dquat(0.97, 0.1, -0.15, 0.05));
  c.camera_from_world.translation_m = dvec3(0.05, -0.04, 2.0);
  return c;
}

// Gaussians in front of the camera; `extent` in metres, `size` their largest standard deviation.
GaussianBuffers randomGaussians(std::size_t n, float extent, float size, int extra, std::uint64_t seed) {
  GaussianBuffers g(n, extra);
  for (std::size_t i = 0; i < n; ++i) {
    const RandomStream r(seed, i);
    for (int k = 0; k < 3; ++k) g.plane(k)[i] = extent * (2 * r.uniform(k) - 1);
    for (int k = 0; k < 4; ++k) g.plane(L::kRotation + k)[i] = r.normal(10 + k);
    for (int k = 0; k < 3; ++k) g.plane(L::kScale + k)[i] = size * (0.15f + 0.85f * r.uniform(20 + k));
    g.plane(L::kOpacity)[i] = 0.2f + 0.75f * r.uniform(30);
    for (int k = 0; k < 48; ++k) g.plane(L::kSh + k)[i] = (k < 3 ? 0.8f : 0.15f) * r.normal(40 + k);
    for (int e = 0; e < extra; ++e) g.plane(L::kExtra + e)[i] = r.uniform(100 + e);
  }
  return g;
}

std::vector<double> inDouble(const GaussianBuffers& g) {
  std::vector<double> v;
  for (int p = 0; p < g.planes(); ++p) v.insert(v.end(), g.plane(p), g.plane(p) + g.count);
  return v;
}

RasterDesc fullDesc(const Camera& c, int extra, bool gradients) {
  return {.width = c.width,
          .height = c.height,
          .geometry = true,
          .extra_channels = extra,
          .gradients = gradients};
}

struct Weights {  // dL/d(picture), fixed random numbers
  RasterImages up;
  explicit Weights(const Camera& c, int extra) {
    up.color = Planes(c.width, c.height, 3);
    up.alpha = Planes(c.width, c.height, 1);
    up.depth = Planes(c.width, c.height, 1);
    up.median_depth = Planes(c.width, c.height, 1);
    up.normal = Planes(c.width, c.height, 3);
    if (extra > 0) up.extra = Planes(c.width, c.height, extra);
    int stream = 0;
    for (Planes* p : {&up.color, &up.alpha, &up.depth, &up.median_depth, &up.normal, &up.extra}) {
      const RandomStream r(77, ++stream);
      for (std::size_t i = 0; i < p->values.size(); ++i) p->values[i] = r.uniform(i) - 0.5f;
    }
  }
  double lossOf(const std::vector<ReferencePixel>& picture) const {
    double loss = 0;
    for (std::size_t p = 0; p < picture.size(); ++p) {
      const ReferencePixel& r = picture[p];
      for (int c = 0; c < 3; ++c)
        loss += up.color.plane(c)[p] * r.color[c] + up.normal.plane(c)[p] * r.normal[c];
      loss +=
          up.alpha.values[p] * r.alpha + up.depth.values[p] * r.depth + up.median_depth.values[p] * r.median;
      for (std::size_t e = 0; e < r.extra.size(); ++e)
        loss += up.extra.plane(static_cast<int>(e))[p] * r.extra[e];
    }
    return loss;
  }
};

TEST(Rasterizer, DrawsWhatTheReferenceDraws) {
  const Camera c = offCentreCamera(45, 38);
  const GaussianBuffers g = randomGaussians(60, 0.5f, 0.12f, 2, 3);
  const vec3 background(0.2f, 0.7f, 0.4f);
  const auto raster = makeCpuDevice()->newRasterizer(fullDesc(c, 2, false));
  RasterImages images;
  raster->forward(g, c, 3, background, images);
  ReferenceOptions o;
  o.background = background;
  const auto expected = ReferenceRaster(g.count, 2, c, o).draw(inDouble(g));
  int flips = 0;
  for (std::size_t p = 0; p < expected.size(); ++p) {
    const ReferencePixel& e = expected[p];
    if (std::abs(images.alpha.values[p] - e.alpha) > 1e-3) {  // the 1/255 step fell on the other side
      ++flips;
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(images.color.plane(k)[p], e.color[k], 4e-3);
      EXPECT_NEAR(images.normal.plane(k)[p], e.normal[k], 4e-3);
    }
    EXPECT_NEAR(images.depth.values[p], e.depth, 6e-3);
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(images.extra.plane(k)[p], e.extra[k], 4e-3);
  }
  EXPECT_LE(flips, static_cast<int>(expected.size() / 200));
}

// Central differences of the reference in double. The 1/255 step is far from every pixel here, since the
// Gaussians are larger than the picture; where a difference straddles a step of order or of the median, both
// sides disagree and the entry does not count.
TEST(Rasterizer, EveryGradientMatchesCentralDifferencesOfTheReference) {
  const Camera c = offCentreCamera(6, 5);
  GaussianBuffers g = randomGaussians(5, 0.12f, 0.8f, 2, 11);
  g.plane(L::kOpacity)[2] = 0.9999f;  // clamped at 0.99 near its centre
  for (int ch = 0; ch < 3; ++ch) g.plane(L::kSh + ch)[3] = ch == 1 ? -9.0f : 0.3f;  // one clamped colour
  const vec3 background(0.3f, 0.6f, 0.1f);
  const auto raster = makeCpuDevice()->newRasterizer(fullDesc(c, 2, true));
  RasterImages images;
  raster->forward(g, c, 3, background, images);
  const Weights weights(c, 2);
  GaussianBuffers gradients;
  raster->backward(weights.up, gradients);
  ReferenceOptions o;
  o.background = background;
  const ReferenceRaster reference(g.count, 2, c, o);
  const std::vector<double> values = inDouble(g);
  int checked = 0, wrong = 0;
  for (std::size_t v = 0; v < values.size(); ++v) {
    const auto lossAt = [&](double h) {
      std::vector<double> moved = values;
      moved[v] += h;
      return weights.lossOf(reference.draw(moved));
    };
    const double h = 1e-5, fine = (lossAt(h) - lossAt(-h)) / (2 * h),
                 coarse = (lossAt(2 * h) - lossAt(-2 * h)) / (4 * h);
    if (std::abs(fine - coarse) > 1e-3 * (std::abs(fine) + 0.1)) continue;
    const int plane = static_cast<int>(v / g.count);
    const double got = gradients.plane(plane)[v % g.count];
    ++checked;
    if (std::abs(got - fine) > 2e-3 * (std::abs(fine) + 0.05)) {
      ++wrong;
      ADD_FAILURE() << "plane " << plane << " Gaussian " << v % g.count << ": " << got << ", expected "
                    << fine;
    }
    if (wrong > 10) break;
  }
  EXPECT_GT(checked, static_cast<int>(values.size() * 8 / 10));
}

std::vector<float> everything(SimdTarget target) {
  const Camera c = offCentreCamera(100, 70);
  const GaussianBuffers g = randomGaussians(500, 0.5f, 0.05f, 3, 5);
  const auto raster = makeCpuDevice(target)->newRasterizer(fullDesc(c, 3, true));
  RasterImages images;
  raster->forward(g, c, 2, vec3(0.1f, 0.2f, 0.3f), images);
  GaussianBuffers gradients;
  raster->backward(Weights(c, 3).up, gradients);
  std::vector<float> all;
  for (const Planes* p :
       {&images.color, &images.alpha, &images.depth, &images.median_depth, &images.normal, &images.extra}) {
    all.insert(all.end(), p->values.begin(), p->values.end());
  }
  all.insert(all.end(), gradients.values.begin(), gradients.values.end());
  return all;
}

TEST(Rasterizer, EveryInstructionSetGivesTheSameBits) {
  const std::vector<float> scalar = everything(SimdTarget::Scalar);
  for (const float v : scalar) ASSERT_TRUE(std::isfinite(v));
  for (const SimdTarget t : {SimdTarget::Avx2, SimdTarget::Avx512}) {
    try {
      EXPECT_EQ(everything(t), scalar) << static_cast<int>(t);
    } catch (const std::exception& e) {
      std::cout << "skipped an instruction set: " << e.what() << "\n";
    }
  }
  makeCpuDevice(SimdTarget::Auto);
}

TEST(Rasterizer, AnyNumberOfThreadsGivesTheSameBits) {
  setThreadCount(1);
  const std::vector<float> one = everything(SimdTarget::Auto);
  setThreadCount(2);
  EXPECT_EQ(everything(SimdTarget::Auto), one);
  setThreadCount(0);
}

TEST(Rasterizer, AnEmptyCloudShowsTheBackground) {
  const Camera c = offCentreCamera(20, 20);
  const auto raster = makeCpuDevice()->newRasterizer(fullDesc(c, 0, true));
  RasterImages images;
  const GaussianBuffers none(0);
  raster->forward(none, c, 3, vec3(0.25f), images);
  for (const float v : images.color.values) EXPECT_EQ(v, 0.25f);
  GaussianBuffers gradients;
  raster->backward(Weights(c, 0).up, gradients);
  EXPECT_EQ(gradients.count, 0u);
}

TEST(Rasterizer, AGaussianBehindTheCameraIsNotDrawn) {
  const Camera c = offCentreCamera(20, 20);
  GaussianBuffers g = randomGaussians(1, 0.1f, 0.1f, 0, 2);
  const dvec3 behind = inverse(c.camera_from_world) * dvec3(0, 0, -1);
  for (int k = 0; k < 3; ++k) g.plane(k)[0] = static_cast<float>(behind[k]);
  const auto raster = makeCpuDevice()->newRasterizer(fullDesc(c, 0, false));
  RasterImages images;
  raster->forward(g, c, 3, vec3(0), images);
  for (const float v : images.alpha.values) EXPECT_EQ(v, 0.0f);
  EXPECT_EQ(raster->screenRadius()[0], 0.0f);
}

// One Gaussian at `position` in the axes of an unrotated camera, thin along `normal`.
GaussianBuffers flatGaussian(dvec3 position, dvec3 normal, float tangent_m, float thin_m) {
  GaussianBuffers g(1);
  for (int k = 0; k < 3; ++k) g.plane(k)[0] = static_cast<float>(position[k]);
  const dvec3 axis = glm::cross(dvec3(0, 0, 1), normal);
  const dquat q = glm::normalize(dquat(1 + normal.z, axis.x, axis.y, axis.z));
  const double w[4] = {q.w, q.x, q.y, q.z};
  for (int k = 0; k < 4; ++k) g.plane(L::kRotation + k)[0] = static_cast<float>(w[k]);
  for (int k = 0; k < 3; ++k) g.plane(L::kScale + k)[0] = k == 2 ? thin_m : tangent_m;
  g.plane(L::kOpacity)[0] = 0.95f;
  return g;
}

RasterImages drawFrontal(const GaussianBuffers& g) {
  Camera c;
  c.width = c.height = 65;
  c.intrinsics = {100, 100, 32.5, 32.5};
  const auto raster = makeCpuDevice()->newRasterizer(fullDesc(c, 0, false));
  RasterImages images;
  raster->forward(g, c, 0, vec3(0), images);
  return images;
}

double normalAngleDeg(const RasterImages& images, dvec3 expected) {
  const std::size_t p = 32 * 65 + 32;
  const dvec3 n(images.normal.plane(0)[p], images.normal.plane(1)[p], images.normal.plane(2)[p]);
  return glm::degrees(std::acos(std::min(1.0, glm::dot(glm::normalize(n), expected))));
}

TEST(RasterizerGeometry, AFlatGaussianSeenObliquelyErrsByItsThicknessRatio) {
  const double incidence = glm::radians(60.0);
  const dvec3 normal(std::sin(incidence), 0, -std::cos(incidence));
  for (const auto& [ratio, expected] : {std::pair{0.3, 8.86}, std::pair{0.1, 0.99}}) {
    const auto thin = static_cast<float>(0.1 * ratio);
    EXPECT_NEAR(normalAngleDeg(drawFrontal(flatGaussian({0, 0, 2}, normal, 0.1f, thin)), normal), expected,
                0.05);
  }
}

TEST(RasterizerGeometry, ARoundGaussianFacesTheViewer) {
  EXPECT_NEAR(normalAngleDeg(drawFrontal(flatGaussian({0, 0, 2}, {0, 0, -1}, 0.1f, 0.1f)), {0, 0, -1}), 0,
              0.05);
}

TEST(RasterizerGeometry, DepthAtTheCentreIsTheCentresDepth) {
  const RasterImages images =
      drawFrontal(flatGaussian({0, 0, 2}, glm::normalize(dvec3(0.5, 0.2, -1)), 0.1f, 0.01f));
  EXPECT_NEAR(images.depth.values[32 * 65 + 32], 2, 1e-5);
  EXPECT_NEAR(images.median_depth.values[32 * 65 + 32], 2, 1e-5);
}

TEST(RasterizerGeometry, DepthOfATiltedPlateIsThePlanesDepth) {
  const dvec3 normal = glm::normalize(dvec3(0.6, -0.3, -1));
  const RasterImages images = drawFrontal(flatGaussian({0, 0, 2}, normal, 0.15f, 1e-4f));
  for (const auto& [x, y] : {std::pair{29, 33}, std::pair{36, 30}, std::pair{32, 36}}) {
    const dvec3 ray((x + 0.5 - 32.5) / 100, (y + 0.5 - 32.5) / 100, 1);
    EXPECT_NEAR(images.depth.values[y * 65 + x], glm::dot(normal, dvec3(0, 0, 2)) / glm::dot(normal, ray),
                1e-3);
  }
}

TEST(Rasterizer, BlendWeightsAddUpToTheCoverage) {
  const Camera c = offCentreCamera(50, 40);
  const GaussianBuffers g = randomGaussians(200, 0.4f, 0.06f, 0, 9);
  const auto raster = makeCpuDevice()->newRasterizer({.width = c.width, .height = c.height});
  RasterImages images;
  raster->forward(g, c, 3, vec3(0), images);
  const BlendWeights w = raster->blendWeights(g, c);
  for (std::size_t p = 0; p < images.alpha.values.size(); ++p) {
    double sum = 0;
    for (std::uint32_t e = w.first[p]; e < w.first[p + 1]; ++e) sum += w.weight[e];
    EXPECT_NEAR(sum, images.alpha.values[p], 1e-5);
  }
}

TEST(Rasterizer, RefusesALens) {
  Camera c = offCentreCamera(50, 40);
  c.lens.model = "later";
  const GaussianBuffers g = randomGaussians(3, 0.4f, 0.06f, 0, 9);
  const auto device = makeCpuDevice();
  const auto raster = device->newRasterizer({.width = c.width, .height = c.height});
  RasterImages images;
  const auto refusal = [](auto&& draw) { return testing::messageOf(Error::Kind::Bug, draw); };
  EXPECT_THAT(refusal([&] { raster->forward(g, c, 3, vec3(0), images); }), ::testing::HasSubstr("\"later\""));
  EXPECT_THAT(refusal([&] { raster->blendWeights(g, c); }), ::testing::HasSubstr("\"later\""));
}

TEST(Rasterizer, CountsAreThoseOfTheDrawnPairs) {
  const Camera c = offCentreCamera(64, 48);
  const GaussianBuffers g = randomGaussians(200, 0.4f, 0.06f, 0, 9);
  const auto raster = makeCpuDevice()->newRasterizer({.width = c.width, .height = c.height});
  RasterImages images;
  raster->forward(g, c, 3, vec3(0), images);
  const RasterCounts n = raster->counts();
  EXPECT_EQ(n.pairs_blended, raster->blendWeights(g, c).weight.size());
  EXPECT_GE(n.pairs_evaluated, n.pairs_blended);
}

}  // namespace
}  // namespace beam
