// SPDX-License-Identifier: Apache-2.0
// Fused meshes and their distances on a sphere of known size.
#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "core/base/error.h"
#include "core/method/evaluate.h"
#include "core/method/tsdf.h"
#include "tests/support/sphere_capture.h"

namespace beam {
namespace {

using testing::SphereCapture;

std::vector<DepthView> depthOfASphere(const SphereCapture& s) {
  std::vector<DepthView> views;
  for (const FrameView& v : testing::photographs(s)) {
    DepthView d{v.camera, Planes(s.size_px, s.size_px, 1), Planes(s.size_px, s.size_px, 1)};
    const Rigid3 world_from_camera = inverse(v.camera.camera_from_world);
    const dvec3 o = world_from_camera.translation_m - dvec3(s.center);
    for (int y = 0; y < s.size_px; ++y) {
      for (int x = 0; x < s.size_px; ++x) {
        const dvec3 ray = rayOf(v.camera.intrinsics, {x + 0.5, y + 0.5}),
                    r = world_from_camera.rotation * ray;
        const double a = glm::dot(r, r), b = glm::dot(o, r), c = glm::dot(o, o) - s.radius_m * s.radius_m;
        if (b * b < a * c) continue;
        d.depth.values[y * s.size_px + x] = static_cast<float>((-b - std::sqrt(b * b - a * c)) / a);
        d.weight.values[y * s.size_px + x] = 1;
      }
    }
    views.push_back(std::move(d));
  }
  return views;
}

TEST(Tsdf, FusesASphereWithinAVoxelAndFacesOutward) {
  const SphereCapture s{.cameras = 14, .size_px = 96};
  const TsdfOptions o{.voxel_m = 0.015f, .truncation_m = 0.06f};
  Progress progress;
  const std::vector<DepthView> views = depthOfASphere(s);
  const auto blocks = touchedBlocks(views, o, 1u << 20, 1, progress);
  const Mesh mesh = keepLargeComponents(*fuseDepth(views, o, *blocks, 1u << 20, progress), 0.01, progress);
  ASSERT_GT(mesh.triangles.size(), 1000u);
  double error = 0;
  std::size_t outward = 0;
  for (const vec3& v : mesh.vertices)
    error += std::abs(glm::length(v - s.center) - s.radius_m) / static_cast<double>(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    const vec3 a = mesh.vertices[t[0]], n = glm::cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
    outward += glm::dot(n, a - s.center) > 0;
  }
  EXPECT_LT(error, 0.5 * o.voxel_m);
  EXPECT_GT(static_cast<double>(outward), 0.97 * static_cast<double>(mesh.triangles.size()));
}

Mesh sphere(float radius, vec3 center) {
  Mesh m;
  constexpr int kRows = 60, kColumns = 120;
  for (int i = 0; i <= kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const float a = kPi * i / kRows, b = 2 * kPi * j / kColumns;
      m.vertices.push_back(center +
                           radius * vec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)));
      if (i == kRows) continue;
      const auto id = [&](int r, int c) { return static_cast<std::uint32_t>(r * kColumns + c % kColumns); };
      m.triangles.push_back({id(i, j), id(i, j + 1), id(i + 1, j)});
      m.triangles.push_back({id(i, j + 1), id(i + 1, j + 1), id(i + 1, j)});
    }
  }
  return m;
}

TEST(Chamfer, OfAMeshWithItselfIsZeroAndBetweenConcentricSpheresTheirGap) {
  EXPECT_LT(chamferDistance(sphere(0.5f, vec3(0)), sphere(0.5f, vec3(0))).chamfer_mm, 0.05);
  const Chamfer c = chamferDistance(sphere(0.5f, vec3(0)), sphere(0.51f, vec3(0)));
  EXPECT_NEAR(c.chamfer_mm, 10, 0.2);
  EXPECT_THROW(chamferDistance({}, sphere(0.5f, vec3(0))), Error);
}

TEST(Scores, NormalsCountMissingOnesAsNinetyDegrees) {
  Planes truth(2, 1, 3), guess(2, 1, 3);
  truth.plane(2)[0] = truth.plane(2)[1] = 1;
  guess.plane(0)[0] = guess.plane(2)[0] = 1;
  EXPECT_NEAR(normalErrorDeg(guess, truth, Image<std::uint8_t>(2, 1, 255)), (45 + 90) / 2.0, 1e-6);
}

TEST(Scores, AConstantErrorGivesItsPsnr) {
  Image<std::uint8_t> mask(20, 20, 255);
  const Planes a(20, 20, 3, 0.5f), b(20, 20, 3, 0.6f);
  EXPECT_NEAR(scorePicture(a, b, mask).psnr, 20, 1e-4);
  EXPECT_NEAR(scorePicture(a, b, mask).psnr_mask, 20, 1e-4);
  EXPECT_EQ(scorePicture(a, a, mask).psnr, 100);
  EXPECT_NEAR(scorePicture(a, a, mask).ssim.value(), 1, 1e-9);
}

TEST(Scores, OfAPictureWithoutRoomForSsimHasNoneAndMeansLeaveItOut) {
  const Planes small(8, 20, 3, 0.5f), other(8, 20, 3, 0.6f);
  const PictureScore without = scorePicture(small, other, Image<std::uint8_t>(8, 20, 255));
  EXPECT_FALSE(without.ssim);
  EXPECT_NEAR(without.psnr, 20, 1e-4);
  const PictureScore both[] = {without, {.psnr = 30, .ssim = 0.8, .psnr_mask = 30}};
  EXPECT_NEAR(meanOf(both).psnr, 25, 1e-4);
  EXPECT_EQ(meanOf(both).ssim, 0.8);
  EXPECT_FALSE(meanOf(std::span(both, 1)).ssim);
}

}  // namespace
}  // namespace beam
