// SPDX-License-Identifier: Apache-2.0
// The visual hull, seeds and training targets of a sphere with known masks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/method/seed_points.h"
#include "core/method/training_views.h"
#include "core/scene/visual_hull.h"
#include "tests/support/sphere_capture.h"

namespace beam {
namespace {

using testing::photographs;
using testing::SphereCapture;

TEST(VisualHull, OfASphereHoldsItsInsideAndNothingFarOutside) {
  const SphereCapture s;
  const auto views = photographs(s);
  const VisualHull hull(views);
  EXPECT_TRUE(hull.contains(s.center));
  EXPECT_TRUE(hull.contains(s.center + vec3(0.9f * s.radius_m, 0, 0)));
  EXPECT_FALSE(hull.contains(s.center + vec3(1.4f * s.radius_m, 0, 0)));
  EXPECT_FALSE(hull.contains(s.center + vec3(50, 0, 0)));
}

TEST(VisualHull, SurfaceCellsLieNearTheSphere) {
  const SphereCapture s{.cameras = 16};
  const auto views = photographs(s);
  const std::vector<vec3> cells = VisualHull(views).surfaceCells(0.02f, Progress());
  ASSERT_GT(cells.size(), 500u);
  for (const vec3& c : cells) {
    const float r = glm::length(c - s.center);
    EXPECT_GT(r, s.radius_m - 0.06f);
    EXPECT_LT(r, s.radius_m + 0.12f);
  }
}

TEST(VisualHull, WithoutMasksHasNoSurface) {
  auto views = photographs({});
  for (FrameView& v : views) v.mask = {};
  EXPECT_TRUE(VisualHull(views).surfaceCells(0.02f, Progress()).empty());
}

TEST(SeedPoints, ComeFromTheHullInTheSameOrderForAnyThreadCount) {
  const auto views = photographs({});
  Progress a, b;
  const PointCloud first = seedPoints(views, {}, 300, 1, a);
  const PointCloud second = seedPoints(views, {}, 300, 1, b);
  ASSERT_EQ(first.position_m.size(), 300u);
  EXPECT_EQ(first.position_m, second.position_m);
  EXPECT_EQ(first.color.size(), 300u);
}

TEST(SeedPoints, FallBackToTheCapturesPointsAndSaySoWhenThereAreNone) {
  auto views = photographs({});
  for (FrameView& v : views) v.mask = {};
  Progress a, b;
  PointCloud points;
  points.position_m = {vec3(0, 1, 0), vec3(0, 1.1f, 0)};
  EXPECT_EQ(seedPoints(views, points, 300, 1, a).position_m.size(), 2u);
  try {
    seedPoints(views, {}, 300, 1, b);
    FAIL() << "expected an error";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Data);
    EXPECT_THAT(e.what(), ::testing::HasSubstr("masks"));
  }
}

TEST(TrainingViews, CropsKeepWhereAPointFallsInThePhotograph) {
  const SphereCapture s{.center = vec3(0.1f, 1.05f, 0)};
  auto views = photographs(s);
  const auto crops = cropToMasks(views);
  ASSERT_EQ(crops.size(), views.size());
  for (std::size_t i = 0; i < crops.size(); ++i) {
    const dvec2 full =
        project(views[i].camera.intrinsics, views[i].camera.camera_from_world * dvec3(s.center));
    const dvec2 crop =
        project(crops[i].camera.intrinsics, crops[i].camera.camera_from_world * dvec3(s.center));
    const auto at = [](const Image<u8vec3>& im, dvec2 p) {
      return im(static_cast<int>(p.x), static_cast<int>(p.y));
    };
    EXPECT_EQ(at(views[i].photo, full), at(crops[i].photo, crop));
    EXPECT_EQ(crops[i].photo.width, crops[0].photo.width);
  }
}

template <class T>
Image<T> leftPart(const Image<T>& in, int width) {
  Image<T> out(width, in.height, T{}, in.encoding);
  for (int y = 0; y < in.height; ++y)
    std::copy_n(&in.pixels[in.index(0, y)], width, &out.pixels[out.index(0, y)]);
  return out;
}

TEST(TrainingViews, BeyondTheBorderOfASmallerPictureNothingIsLearned) {
  auto views = photographs({});
  const int half = views[0].camera.width / 2;
  views[0].photo = leftPart(views[0].photo, half);
  views[0].mask = leftPart(views[0].mask, half);
  views[0].camera.width = half;
  const TrainingView cut = cropToMasks(views)[0];
  ASSERT_LT(cut.known_width, cut.photo.width) << "the subject goes on beyond the border";
  EXPECT_TRUE(cropToMasks(views)[1].whole());
  Planes target, rendered(cut.photo.width, cut.photo.height, 3), alpha(cut.photo.width, cut.photo.height, 1);
  std::fill(rendered.values.begin(), rendered.values.end(), 0.625f);
  std::fill(alpha.values.begin(), alpha.values.end(), 0.5f);
  compose(cut, vec3(0.25f), target);
  const Planes composed = target;
  acceptUnknown(cut, rendered, target);
  Planes gradient;
  maskLoss(alpha, cut, 1, gradient);
  for (std::size_t i = 0; i < alpha.planeSize(); ++i) {
    const bool known = static_cast<int>(i % static_cast<std::size_t>(cut.photo.width)) < cut.known_width;
    EXPECT_EQ(target.plane(1)[i], known ? composed.plane(1)[i] : 0.625f);
    EXPECT_EQ(gradient.values[i] != 0, known);
  }
}

TEST(TrainingViews, ComposeShowsTheBackgroundOutsideTheMaskOnly) {
  const auto views = photographs({});
  const auto crops = cropToMasks(views);
  ASSERT_TRUE(crops[0].premultiplied);
  Planes target;
  compose(crops[0], vec3(0.25f, 0.5f, 0.75f), target);
  for (std::size_t i = 0; i < target.planeSize(); ++i) {
    const float expected = crops[0].mask.pixels[i] ? crops[0].photo.pixels[i].y / 255.0f : 0.5f;
    EXPECT_FLOAT_EQ(target.plane(1)[i], expected);
  }
}

}  // namespace
}  // namespace beam
