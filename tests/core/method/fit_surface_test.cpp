// SPDX-License-Identifier: Apache-2.0
// The Surface fit on a textured sphere of known shape: it must learn pictures, place and normals, repeat to
// the bit, and stop when asked.
#include "core/method/fit_surface.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/metrics.h"
#include "core/method/seed_points.h"
#include "tests/support/sphere_capture.h"

namespace beam {
namespace {

using testing::photographs;
using testing::SphereCapture;

FitSurfaceOptions quick(int iterations) {
  FitSurfaceOptions o;
  o.iterations = iterations;
  o.refine_fraction = 0.4;
  o.cap = 1500;
  o.filter = 0;
  o.normal_weight = 0.1;
  return o;
}

GaussianCloud fit(const std::vector<FrameView>& views, const FitSurfaceOptions& o, Progress& progress) {
  const auto device = makeCpuDevice();
  PointCloud seeds;
  {
    Progress part = progress.part(0.1, "seeds");
    seeds = seedPoints(views, {}, static_cast<int>(o.cap * o.seed_share), o.seed, part);
  }
  GaussianCloud cloud;
  {
    Progress part = progress.part(0.5, "appearance");
    cloud = fitAppearance(views, seeds, o, *device, part);
  }
  Progress part = progress.part(0.4, "geometry");
  return refineGeometry(views, cloud, o, *device, part);
}

TEST(FitSurface, LearnsASphereSoThatAnUnseenViewIsRight) {
  const SphereCapture s{.cameras = 14};
  Progress progress;
  const GaussianCloud cloud = fit(photographs(s), quick(700), progress);
  validate(cloud);
  const Camera unseen =
      testing::cameraLookingAt(dvec3(s.center) + dvec3(1.1, 0.5, 1.5), s.center, s.size_px, 1.4 * s.size_px);
  const FrameView truth = testing::photographSphere(s, unseen, "unseen");
  const auto raster =
      makeCpuDevice()->newRasterizer({.width = s.size_px, .height = s.size_px, .geometry = true});
  RasterImages images;
  raster->forward(toBuffers(cloud), unseen, 3, vec3(0), images);
  Planes photo(s.size_px, s.size_px, 3);
  double angle = 0, distance = 0;
  int inner = 0;
  const Rigid3 world_from_camera = inverse(unseen.camera_from_world);
  for (int y = 0; y < s.size_px; ++y) {
    for (int x = 0; x < s.size_px; ++x) {
      const std::size_t p = truth.photo.index(x, y);
      for (int c = 0; c < 3; ++c) photo.plane(c)[p] = truth.photo.pixels[p][c] / 255.0f;
      const float z = images.median_depth.values[p];
      if (truth.mask.pixels[p] == 0 || z <= 0) continue;
      const dvec3 x_in_world =
          world_from_camera * (static_cast<double>(z) * rayOf(unseen.intrinsics, {x + 0.5, y + 0.5}));
      const dvec3 n(images.normal.plane(0)[p], images.normal.plane(1)[p], images.normal.plane(2)[p]);
      const dvec3 expected = glm::normalize(x_in_world - dvec3(s.center));
      const double facing = glm::dot(expected, glm::normalize(world_from_camera.translation_m - x_in_world));
      if (facing < 0.4) continue;
      angle += std::acos(
          std::clamp(glm::dot(world_from_camera.rotation * glm::normalize(n), expected), -1.0, 1.0));
      distance += std::abs(glm::length(x_in_world - dvec3(s.center)) - s.radius_m);
      ++inner;
    }
  }
  EXPECT_GT(psnr(images.color, photo, {0, 0, s.size_px, s.size_px}), 27);
  ASSERT_GT(inner, 300);
  EXPECT_LT(distance / inner, 0.022);  // a pixel
  EXPECT_LT(glm::degrees(angle / inner), 12);
}

TEST(FitSurface, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto views = photographs({.cameras = 6});
  Progress a, b;
  setThreadCount(1);
  const GaussianCloud one = fit(views, quick(60), a);
  setThreadCount(2);
  const GaussianCloud two = fit(views, quick(60), b);
  setThreadCount(0);
  EXPECT_EQ(one.position_m, two.position_m);
  EXPECT_EQ(one.opacity, two.opacity);
  EXPECT_EQ(one.color.coefficients, two.color.coefficients);
}

TEST(FitSurface, StopsWhenAskedTo) {
  const auto views = photographs({.cameras = 6});
  std::stop_source stop;
  Progress progress(stop.get_token(), [&](const ProgressReport& r) {
    if (r.fraction > 0.1002) stop.request_stop();
  });
  EXPECT_THROW(fit(views, quick(100000), progress), Cancelled);
}

}  // namespace
}  // namespace beam
