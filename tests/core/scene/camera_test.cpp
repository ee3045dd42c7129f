// SPDX-License-Identifier: Apache-2.0
// Cameras, and the axes that a capture is turned into.
#include "core/scene/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/rng.h"
#include "core/scene/capture.h"

namespace beam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// A lens off the middle, a pixel that is not square, a camera turned anyhow.
Camera oddCamera() {
  Camera c{{640.5, 655.25, 301.75, 222.5}, 600, 480, {}};
  c.camera_from_world = {glm::normalize(dquat(0.8, 0.3, -0.4, 0.2)), {0.4, -1.1, 2.5}};
  return c;
}

dvec3 somePoint(const RandomStream& random, std::uint64_t i) {
  return dvec3(random.normal(3 * i), random.normal(3 * i + 1), random.normal(3 * i + 2));
}

TEST(Camera, ProjectingUndoesTheRayAndTheRayUndoesProjecting) {
  const Intrinsics k = oddCamera().intrinsics;
  const RandomStream random(1);
  for (int i = 0; i < 200; ++i) {
    const dvec2 pixel(600 * random.uniform(3 * i), 480 * random.uniform(3 * i + 1));
    const double depth_m = 0.1 + 9 * random.uniform(3 * i + 2);
    EXPECT_LT(glm::distance(project(k, depth_m * rayOf(k, pixel)), pixel), 1e-9);
    const dvec3 x = depth_m * rayOf(k, pixel);
    EXPECT_LT(glm::distance(x.z * rayOf(k, project(k, x)), x), 1e-12);
  }
}

TEST(Camera, LooksAlongPlusZWithXToTheRightAndYDown) {
  const Intrinsics k{100, 100, 32, 24};
  EXPECT_EQ(project(k, dvec3(0, 0, 2)), dvec2(32, 24));
  EXPECT_GT(project(k, dvec3(1, 0, 2)).x, 32);
  EXPECT_GT(project(k, dvec3(0, 1, 2)).y, 24);
}

TEST(Camera, StandsWhereItsOwnOriginIs) {
  const Camera c = oddCamera();
  EXPECT_LT(glm::length(c.camera_from_world * centerOf(c)), 1e-12);
}

TEST(Rigid3, InvertsAndComposes) {
  const Rigid3 a_from_b = oddCamera().camera_from_world,
               b_from_c{glm::normalize(dquat(-0.1, 0.7, 0.2, 0.5)), {3, 2, 1}};
  const RandomStream random(2);
  for (int i = 0; i < 50; ++i) {
    const dvec3 x = somePoint(random, i);
    EXPECT_LT(glm::distance(inverse(a_from_b) * (a_from_b * x), x), 1e-12);
    EXPECT_LT(glm::distance((a_from_b * b_from_c) * x, a_from_b * (b_from_c * x)), 1e-12);
  }
}

TEST(ScaledDown, SeesThePointsAtTheFactor) {
  const Camera c = oddCamera();
  const RandomStream random(3);
  for (const int factor : {1, 2, 3, 4, 5}) {
    const Camera small = scaledDown(c, factor);
    EXPECT_EQ(small.width * factor, c.width);
    EXPECT_EQ(small.height * factor, c.height);
    for (int i = 0; i < 20; ++i) {
      const dvec3 x = somePoint(random, i) + dvec3(0, 0, 5);
      EXPECT_LT(glm::distance(project(small.intrinsics, x), project(c.intrinsics, x) / double(factor)), 1e-9);
    }
  }
}

TEST(ValidCamera, IsRefusedByNameForWhatIsWrongWithIt) {
  EXPECT_NO_THROW(validate(oddCamera(), "C07"));
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto refused = [](const char* reason, auto&& spoil) {
    Camera c = oddCamera();
    spoil(c);
    try {
      validate(c, "C07");
      ADD_FAILURE() << "expected a refusal: " << reason;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), Error::Kind::Data);
      EXPECT_THAT(e.what(), AllOf(HasSubstr("C07"), HasSubstr(reason)));
    }
  };
  for (const double bad : {0.0, -3.0, nan, inf}) {
    refused("focal length fx", [&](Camera& c) { c.intrinsics.fx = bad; });
    refused("focal length fy", [&](Camera& c) { c.intrinsics.fy = bad; });
  }
  for (const double bad : {nan, inf, -inf}) {
    refused("principal point cx", [&](Camera& c) { c.intrinsics.cx = bad; });
    refused("principal point cy", [&](Camera& c) { c.intrinsics.cy = bad; });
    refused("translation", [&](Camera& c) { c.camera_from_world.translation_m.y = bad; });
    refused("quaternion", [&](Camera& c) { c.camera_from_world.rotation.z = bad; });
  }
  refused("width", [](Camera& c) { c.width = 0; });
  refused("height", [](Camera& c) { c.height = -1; });
  refused("quaternion", [](Camera& c) { c.camera_from_world.rotation = dquat(0, 0, 0, 0); });
  refused("quaternion", [](Camera& c) { c.camera_from_world.rotation *= 1.01; });
}

TEST(CaptureAxes, AreTurnedIntoTheHousesWithoutAMirror) {
  const std::pair<UpAxis, dvec3> axes[] = {
      {UpAxis::PlusY, {0, 1, 0}}, {UpAxis::PlusZ, {0, 0, 1}}, {UpAxis::MinusY, {0, -1, 0}}};
  for (const auto& [axis, up] : axes) {
    const dmat3 world_from_capture = worldFromCapture(axis);
    EXPECT_EQ(world_from_capture * up, dvec3(0, 1, 0)) << toText(axis);
    EXPECT_EQ(glm::determinant(world_from_capture), 1) << toText(axis);
    EXPECT_EQ(world_from_capture * glm::transpose(world_from_capture), dmat3(1)) << toText(axis);
  }
}

TEST(CaptureAxes, ArePermutationsOfTheCapturesOwn) {
  const dvec3 p(1, 2, 3);
  EXPECT_EQ(worldFromCapture(UpAxis::PlusY) * p, p);
  EXPECT_EQ(worldFromCapture(UpAxis::PlusZ) * p, dvec3(2, 3, 1)) << "x = y, y = z, z = x of the capture";
  EXPECT_EQ(worldFromCapture(UpAxis::MinusY) * p, dvec3(1, -2, -3));
  EXPECT_EQ(toText(UpAxis::PlusY) + toText(UpAxis::PlusZ) + toText(UpAxis::MinusY), "+Y+Z-Y");
}

TEST(FittedTo, ShowsAllThatTheCameraSawInTheMiddleOfThePicture) {
  const Camera camera = oddCamera();
  for (const ivec2& size : {ivec2(1200, 960), ivec2(300, 240), ivec2(1920, 1080), ivec2(400, 900)}) {
    const Camera c = fittedTo(camera, size.x, size.y);
    EXPECT_EQ(ivec2(c.width, c.height), size);
    EXPECT_EQ(c.camera_from_world, camera.camera_from_world);
    EXPECT_DOUBLE_EQ(c.intrinsics.fx / c.intrinsics.fy, camera.intrinsics.fx / camera.intrinsics.fy);
    // Corners of the old picture lie as far from the new one's edges on both sides, and on one pair of them.
    const dvec2 low = project(c.intrinsics, rayOf(camera.intrinsics, {0, 0})),
                high = project(c.intrinsics, rayOf(camera.intrinsics, {camera.width, camera.height}));
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(low[k], size[k] - high[k], 1e-9);
      EXPECT_GE(low[k], -1e-9);
    }
    EXPECT_NEAR(std::min(low.x, low.y), 0, 1e-9);
  }
}

}  // namespace
}  // namespace beam
