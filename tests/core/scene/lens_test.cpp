// SPDX-License-Identifier: Apache-2.0
// Lenses: laws that hold of every model. A new one is added to kLenses.
#include "core/scene/lens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/base/rng.h"
#include "core/scene/camera.h"
#include "core/scene/visual_hull.h"
#include "tests/support/message_of.h"

namespace beam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::messageOf;

const Lens kLenses[] = {{}};

constexpr double kStep = 1e-5, kClose = 1e-8;

Camera cameraWith(const Lens& lens) {
  Camera c{{640.5, 655.25, 301.75, 222.5}, 600, 480, {}, lens};
  return c;
}

// Points that a picture of cameraWith(lens) shows, undistorted.
std::vector<dvec2> shownPoints(const Lens& lens) {
  const LensRegion region = validRegion(cameraWith(lens));
  const RandomStream random(1);
  std::vector<dvec2> points;
  for (int i = 0; i < 200; ++i) {
    const dvec2 t(random.uniform(2 * i), random.uniform(2 * i + 1));
    const auto back = undistort(lens, region.low + t * (region.high - region.low));
    if (back && glm::length(back->point) < 0.99 * region.radius) points.push_back(back->point);
  }
  EXPECT_GT(points.size(), 100u) << lens.model;
  return points;
}

// Compares both Jacobians with central differences of `function(lens, point)`, which gives a LensPoint.
template <class Function>
void expectJacobians(Function function, const Lens& lens, const dvec2& at) {
  const LensPoint told = function(lens, at);
  for (int i = 0; i < 2; ++i) {
    dvec2 step(0);
    step[i] = kStep;
    const dvec2 slope = (function(lens, at + step).point - function(lens, at - step).point) / (2 * kStep);
    EXPECT_LT(glm::distance(told.by_point[i], slope), kClose) << lens.model << ", coordinate " << i;
  }
  for (std::size_t i = 0; i < kMostLensParameters; ++i) {
    if (i >= parameterCount(lens)) {
      EXPECT_EQ(told.by_parameter[i], dvec2(0)) << lens.model << ", beyond its parameters: " << i;
      continue;
    }
    Lens more = lens, less = lens;
    more.parameters[i] += kStep;
    less.parameters[i] -= kStep;
    const dvec2 slope = (function(more, at).point - function(less, at).point) / (2 * kStep);
    EXPECT_LT(glm::distance(told.by_parameter[i], slope), kClose) << lens.model << ", parameter " << i;
  }
}

TEST(Lens, UndistortingUndoesDistorting) {
  for (const Lens& lens : kLenses) {
    for (const dvec2& point : shownPoints(lens)) {
      const auto back = undistort(lens, distort(lens, point).point);
      ASSERT_TRUE(back) << lens.model;
      EXPECT_LT(glm::distance(back->point, point), 1e-12) << lens.model;
    }
  }
}

TEST(Lens, JacobiansAreThoseOfFiniteDifferences) {
  const auto back = [](const Lens& lens, const dvec2& point) { return undistort(lens, point).value(); };
  for (const Lens& lens : kLenses) {
    for (const dvec2& point : shownPoints(lens)) {
      expectJacobians(distort, lens, point);
      expectJacobians(back, lens, distort(lens, point).point);
    }
  }
}

TEST(Lens, BendsNothingOnTheAxisAndKeepsTheSidesOfThePicture) {
  for (const Lens& lens : kLenses) {
    EXPECT_EQ(distort(lens, dvec2(0)).point, dvec2(0)) << lens.model;
    for (const dvec2& point : shownPoints(lens))
      EXPECT_GT(glm::determinant(distort(lens, point).by_point), 0) << lens.model;
  }
}

TEST(Lens, IsValidWithFiniteParametersOfAKnownModel) {
  for (const Lens& lens : kLenses) {
    EXPECT_NO_THROW(validate(cameraWith(lens), "C07"));
    EXPECT_THAT(lensModels(), ::testing::Contains(lens.model));
    for (std::size_t i = 0; i < kMostLensParameters; ++i) {
      Lens spoilt = lens;
      spoilt.parameters[i] = i < parameterCount(lens) ? std::numeric_limits<double>::infinity() : 1;
      EXPECT_THAT(messageOf(Error::Kind::Data, [&] { validate(cameraWith(spoilt), "C07"); }),
                  AllOf(HasSubstr("C07"), HasSubstr(lens.model)));
    }
  }
}

TEST(Lens, EveryModelIsTestedHere) {
  for (const std::string& model : lensModels()) {
    EXPECT_TRUE(std::any_of(std::begin(kLenses), std::end(kLenses), [&](const Lens& l) {
      return l.model == model;
    })) << model;
  }
}

TEST(Lens, OfAnUnknownModelIsRefused) {
  const Lens later{"later", {0.1}};
  EXPECT_THAT(messageOf(Error::Kind::Data, [&] { validate(cameraWith(later), "C07"); }),
              AllOf(HasSubstr("C07"), HasSubstr("pinhole"), HasSubstr("\"later\"")));
  EXPECT_THAT(messageOf(Error::Kind::Bug, [&] { distort(later, dvec2(0)); }), HasSubstr("\"later\""));
  messageOf(Error::Kind::Bug, [&] { undistort(later, dvec2(0)); });
  messageOf(Error::Kind::Bug, [&] { validRegion(cameraWith(later)); });
}

TEST(Pinhole, BendsNothing) {
  for (const dvec2& point : shownPoints({})) {
    EXPECT_EQ(distort({}, point).point, point);
    EXPECT_EQ(distort({}, point).by_point, dmat2(1));
    EXPECT_EQ(undistort({}, point).value().point, point);
  }
}

TEST(Pinhole, IsKnownInItsWholePicture) {
  const Camera camera = cameraWith({});
  const LensRegion region = validRegion(camera);
  EXPECT_EQ(region.radius, std::numeric_limits<double>::infinity());
  EXPECT_LT(glm::distance(project(camera.intrinsics, dvec3(region.low, 1)), dvec2(0)), 1e-9);
  EXPECT_LT(glm::distance(project(camera.intrinsics, dvec3(region.high, 1)), dvec2(600, 480)), 1e-9);
}

TEST(Pinhole, IsWhatTheMethodAsksFor) {
  EXPECT_NO_THROW(requirePinhole(cameraWith({}), "carving"));
  FrameView view;
  view.camera = cameraWith({"later", {0.1}});
  EXPECT_THAT(messageOf(Error::Kind::Bug,
                        [&] {
                          VisualHull({&view, 1});
                        }),
              AllOf(HasSubstr("visual hull"), HasSubstr("\"later\"")));
}

TEST(Camera, EqualsAnotherOnlyWithTheSameLens) {
  const Camera camera = cameraWith({});
  EXPECT_EQ(camera, cameraWith({}));
  const auto differs = [&](auto&& change) {
    Camera other = camera;
    change(other);
    return other != camera;
  };
  EXPECT_TRUE(differs([](Camera& c) { c.intrinsics.cy += 1; }));
  EXPECT_TRUE(differs([](Camera& c) { c.width += 1; }));
  EXPECT_TRUE(differs([](Camera& c) { c.camera_from_world.translation_m.z += 1; }));
  EXPECT_TRUE(differs([](Camera& c) { c.camera_from_world.rotation = dquat(0, 1, 0, 0); }));
  EXPECT_TRUE(differs([](Camera& c) { c.lens.parameters[11] = 1; }));
  EXPECT_TRUE(differs([](Camera& c) { c.lens.model = "later"; }));
}

}  // namespace
}  // namespace beam
