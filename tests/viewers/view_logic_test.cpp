// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <future>

#include "core/math/color.h"
#include "viewers/encode.h"
#include "viewers/false_color.h"
#include "viewers/image/picture.h"
#include "viewers/latest_worker.h"
#include "viewers/orbit_camera.h"
#include "viewers/splat/channel_picture.h"
#include "viewers/view_keys.h"
#include "viewers/view_state.h"

namespace beam {
namespace {

dvec2 pixelOf(const Camera& camera, vec3 point) {
  return project(camera.intrinsics, camera.camera_from_world * dvec3(point));
}

TEST(OrbitCamera, SeesItsTargetInTheMiddleOfThePicture) {
  OrbitCamera orbit{.target_m = vec3(0.3f, 1.1f, -0.4f), .azimuth_rad = 1.2f, .elevation_rad = -0.5f};
  const Camera camera = orbit.camera(640, 480);
  const dvec2 p = pixelOf(camera, orbit.target_m);
  EXPECT_NEAR(p.x, 320, 1e-3);
  EXPECT_NEAR(p.y, 240, 1e-3);
  EXPECT_NEAR((camera.camera_from_world * dvec3(orbit.target_m)).z, orbit.distance_m, 1e-4);
}

TEST(OrbitCamera, HasTheWorldsUpAtTheTopAndStandsAtPlusZ) {
  const OrbitCamera orbit{.target_m = vec3(0), .elevation_rad = 0};
  const Camera camera = orbit.camera(200, 200);
  EXPECT_GT(centerOf(camera).z, 0);
  EXPECT_LT(pixelOf(camera, vec3(0, 0.2f, 0)).y, 100);
  EXPECT_GT(pixelOf(camera, vec3(0.2f, 0, 0)).x, 100);
}

TEST(OrbitCamera, TurnsTheFrontOfTheSceneWithTheHand) {
  OrbitCamera orbit{.target_m = vec3(0), .elevation_rad = 0};
  const vec3 front(0, 0, 0.5f);
  orbit.orbit({50, 0});
  EXPECT_GT(pixelOf(orbit.camera(200, 200), front).x, 100);
  orbit = {.target_m = vec3(0), .elevation_rad = 0};
  orbit.orbit({0, 50});
  EXPECT_GT(pixelOf(orbit.camera(200, 200), front).y, 100);
}

TEST(OrbitCamera, PansWhatLiesAtTheTargetUnderTheHand) {
  OrbitCamera orbit{.azimuth_rad = 0.7f, .elevation_rad = 0.4f};
  const vec3 held = orbit.target_m;
  orbit.pan({37, -21}, 480);
  const dvec2 p = pixelOf(orbit.camera(640, 480), held);
  EXPECT_NEAR(p.x, 320 + 37, 1e-2);
  EXPECT_NEAR(p.y, 240 - 21, 1e-2);
}

TEST(OrbitCamera, NeverTurnsOverThePole) {
  OrbitCamera orbit;
  orbit.orbit({0, 100000});
  EXPECT_LT(orbit.elevation_rad, kPi / 2);
  EXPECT_TRUE(std::isfinite(orbit.camera(64, 64).camera_from_world.translation_m.x));
}

TEST(OrbitCamera, ZoomsInAndOutToTheSameDistance) {
  OrbitCamera orbit;
  orbit.zoom(3);
  EXPECT_LT(orbit.distance_m, 3);
  orbit.zoom(-3);
  EXPECT_NEAR(orbit.distance_m, 3, 1e-5);
}

TEST(OrbitCamera, ZoomsToThePointThatLiesUnderThePointer) {
  const ivec2 size(640, 480);
  for (const vec2& pointer : {vec2(100, 400), vec2(320, 240), vec2(639, 0)}) {
    OrbitCamera orbit{.target_m = vec3(0.4f, 1, -2), .azimuth_rad = 0.7f, .elevation_rad = 0.4f};
    const Camera before = orbit.camera(size.x, size.y);
    const vec3 held(inverse(before.camera_from_world) *
                    (static_cast<double>(orbit.distance_m) * rayOf(before.intrinsics, dvec2(pointer))));
    for (const float steps : {2.0f, 0.25f, -5.0f}) {
      orbit.zoomAt(steps, pointer, size);
      const Camera after = orbit.camera(size.x, size.y);
      EXPECT_NEAR(pixelOf(after, held).x, pointer.x, 0.02);
      EXPECT_NEAR(pixelOf(after, held).y, pointer.y, 0.02);
      EXPECT_NEAR((after.camera_from_world * dvec3(held)).z, orbit.distance_m, 1e-4);
    }
    EXPECT_GT(orbit.distance_m, 3);
  }
}

TEST(OrbitCamera, StaysWhereItIsWhenItCannotComeCloser) {
  OrbitCamera orbit;
  orbit.zoomAt(1000, {10, 10}, {640, 480});
  const vec3 target = orbit.target_m;
  orbit.zoomAt(10, {10, 10}, {640, 480});
  EXPECT_EQ(orbit.target_m, target);
}

TEST(OrbitCamera, LooksAlongTheAxisOfItsPresetAtTheSameTarget) {
  const std::pair<ViewPreset, dvec3> eyes[] = {
      {ViewPreset::Front, {0, 0, 1}}, {ViewPreset::Back, {0, 0, -1}}, {ViewPreset::Right, {1, 0, 0}},
      {ViewPreset::Left, {-1, 0, 0}}, {ViewPreset::Top, {0, 1, 0}},   {ViewPreset::Bottom, {0, -1, 0}}};
  for (const auto& [preset, eye] : eyes) {
    OrbitCamera orbit{.target_m = vec3(0.3f, 1.1f, -0.4f), .azimuth_rad = 2.2f, .distance_m = 1.7f};
    orbit.turnTo(preset);
    const Camera camera = orbit.camera(200, 200);
    EXPECT_NEAR(glm::distance(centerOf(camera), dvec3(orbit.target_m) + 1.7 * eye), 0, 1e-5);
    EXPECT_EQ(orbit.target_m, vec3(0.3f, 1.1f, -0.4f));
  }
}

TEST(OrbitCamera, HasXToTheRightFromTheTopAndTurnsOnFromThere) {
  OrbitCamera orbit{.target_m = vec3(0)};
  orbit.turnTo(ViewPreset::Top);
  EXPECT_NEAR(pixelOf(orbit.camera(200, 200), vec3(0.2f, 0, 0)).y, 100, 1e-3);
  EXPECT_GT(pixelOf(orbit.camera(200, 200), vec3(0.2f, 0, 0)).x, 110);
  orbit.orbit({0, -100});
  EXPECT_LT(orbit.elevation_rad, 1.0f);
}

TEST(OrbitCamera, FocusesOnAPointFromWhereTheEyeLooksAtIt) {
  OrbitCamera orbit{.azimuth_rad = 0.7f, .elevation_rad = 0.4f};
  const dvec3 eye = centerOf(orbit.camera(200, 200));
  const vec3 point(0.3f, 1.4f, 0.2f);
  orbit.focusOn(point);
  EXPECT_NEAR(orbit.distance_m, glm::distance(eye, dvec3(point)), 1e-5);
  EXPECT_NEAR(pixelOf(orbit.camera(200, 200), point).x, 100, 1e-3);
  EXPECT_NEAR(pixelOf(orbit.camera(200, 200), point).y, 100, 1e-3);
  EXPECT_EQ(orbit.azimuth_rad, 0.7f);
  EXPECT_EQ(orbit.elevation_rad, 0.4f);
}

TEST(ViewKeys, ReadTheNumberPadWithAndWithoutNumLock) {
  const auto preset = [](int key, Qt::KeyboardModifiers with) {
    return presetOf(QKeyEvent(QEvent::KeyPress, key, with));
  };
  EXPECT_EQ(preset(Qt::Key_1, Qt::KeypadModifier), ViewPreset::Front);
  EXPECT_EQ(preset(Qt::Key_PageDown, Qt::KeypadModifier), ViewPreset::Right);
  EXPECT_EQ(preset(Qt::Key_7, Qt::KeypadModifier | Qt::ControlModifier), ViewPreset::Bottom);
  EXPECT_EQ(preset(Qt::Key_1, Qt::NoModifier), std::nullopt);
}

TEST(OrbitCamera, IsRecoveredFromTheCameraItMakes) {
  const OrbitCamera orbit{
      .target_m = vec3(1, 2, 3), .azimuth_rad = -2.1f, .elevation_rad = 0.6f, .distance_m = 1.7f};
  const OrbitCamera back = orbitOf(orbit.camera(300, 200), 1.7f);
  EXPECT_NEAR(glm::distance(back.target_m, orbit.target_m), 0, 1e-5);
  EXPECT_NEAR(back.azimuth_rad, orbit.azimuth_rad, 1e-5);
  EXPECT_NEAR(back.elevation_rad, orbit.elevation_rad, 1e-5);
  EXPECT_NEAR(back.field_of_view_rad, orbit.field_of_view_rad, 1e-5);
}

TEST(FittedCamera, ShowsTheWholePictureCentredInAWindowOfAnotherShape) {
  Camera camera = OrbitCamera{}.camera(480, 640);
  camera.intrinsics.cx = 251;
  const Camera wide = fittedTo(camera, 1600, 800);
  const double scale = 800.0 / 640;
  const dvec2 before = pixelOf(camera, vec3(0.2f, 1.3f, 0.1f)), after = pixelOf(wide, vec3(0.2f, 1.3f, 0.1f));
  EXPECT_NEAR(after.x, before.x * scale + (1600 - 480 * scale) / 2, 1e-6);
  EXPECT_NEAR(after.y, before.y * scale, 1e-6);
}

TEST(FalseColor, GrowsInLightnessAndClamps) {
  const auto light = [](float t) {
    const u8vec3 c = falseColor(t);
    return luminance(linearFromSrgb(vec3(c) / 255.0f));
  };
  for (int i = 1; i <= 20; ++i) EXPECT_GT(light(i / 20.0f), light((i - 1) / 20.0f)) << i;
  EXPECT_EQ(falseColor(-3), falseColor(0.0f));
  EXPECT_EQ(falseColor(7), falseColor(1.0f));
  EXPECT_EQ(falseColor(std::nanf("")), falseColor(0.0f));
}

TEST(FalseColor, TakesLimitsThatLeaveOutStrayValues) {
  std::vector<float> values(1000, 0.0f);
  for (int i = 0; i < 900; ++i) values[i] = 2 + 0.001f * static_cast<float>(i);
  values[950] = 1e6f;
  const Limits limits = robustLimits(values);
  EXPECT_NEAR(limits.low, 2, 0.02);
  EXPECT_NEAR(limits.high, 2.9, 0.02);
  const std::vector<float> equal(10, 3.0f);
  EXPECT_GT(robustLimits(equal).high, robustLimits(equal).low);
}

TEST(SrgbEncoder, IsWithinOneLevelOfTheCurve) {
  for (int i = -10; i <= 1100; ++i) {
    const float linear = static_cast<float>(i) / 1000;
    const float exact = 255 * srgbFromLinear(std::clamp(linear, 0.0f, 1.0f));
    EXPECT_NEAR(SrgbEncoder::instance()(linear), exact, 1.0) << linear;
  }
}

TEST(LatestWorker, DoesTheNewestJobAndForgetsThoseItNeverBegan) {
  LatestWorker worker;
  std::promise<void> begun, go;
  std::atomic<int> sum = 0;
  worker.submit([&] {
    begun.set_value();
    go.get_future().wait();
    sum += 1;
  });
  begun.get_future().wait();
  for (int i = 0; i < 100; ++i) worker.submit([&] { sum += 10; });
  worker.submit([&] { sum += 1000; });
  go.set_value();
  worker.waitUntilIdle();
  EXPECT_EQ(sum, 1001);
}

TEST(LatestWorker, StopsWithAJobStillWaiting) {
  std::atomic<bool> second = false;
  {
    LatestWorker worker;
    std::promise<void> begun;
    worker.submit([&] { begun.set_value(); });
    begun.get_future().wait();
    worker.waitUntilIdle();
  }
  EXPECT_FALSE(second);
}

Planes plane(float value) { return Planes(1, 1, 1, value); }

Planes triple(vec3 value) {
  Planes p(1, 1, 3);
  for (int c = 0; c < 3; ++c) p.values[c] = value[c];
  return p;
}

const ChannelInfo& rgb() { return channelOf(kRgbChannel); }

TEST(ChannelPicture, ShowsColourAsPhotographed) {
  const Image<u8vec4> picture = channelPicture(rgb(), triple({0.8f, 0.4f, 0.2f}), plane(1), {}, {});
  EXPECT_NEAR(picture.pixels[0].x, 204, 1);
  EXPECT_NEAR(picture.pixels[0].y, 102, 1);
  EXPECT_NEAR(picture.pixels[0].z, 51, 1);
}

TEST(ChannelPicture, ShowsNormalsAsColoursAndNothingWhereAChannelIsMissing) {
  const Image<u8vec4> normal = channelPicture(channelOf(kNormalChannel), triple({0, 1, 0}), plane(1), {}, {});
  EXPECT_EQ(normal.pixels[0], u8vec4(128, 255, 128, 255));
  const Image<u8vec4> missing = channelPicture(channelOf(kBaseColorChannel), {}, plane(1), {}, {});
  const Image<u8vec4> empty = channelPicture(rgb(), triple(vec3(0)), plane(0), {}, {});
  EXPECT_EQ(missing.pixels[0], empty.pixels[0]);
}

TEST(ChannelPicture, PutsTheSkyBehindWhatIsHalfThere) {
  const Image<vec3> sky(1, 1, vec3(0.5f));
  const Image<u8vec4> picture =
      channelPicture(channelOf(kRelightChannel), triple(vec3(0.25f)), plane(0.5f), sky, {});
  EXPECT_NEAR(picture.pixels[0].x, 255 * srgbFromLinear(0.5f), 1);
}

TEST(ChannelPicture, ReadsTheValueOfTheSurfaceNotOfTheBlend) {
  EXPECT_EQ(describePixel(rgb(), triple({0.4f, 0.2f, 0.1f}), plane(0.5f), 0, 0),
            "Colour sRGB 0.800 0.400 0.200 · alpha 0.50");
  const ChannelInfo& depth = channelOf(kDepthChannel);
  EXPECT_EQ(describePixel(depth, plane(2.5f), plane(1), 0, 0), "Depth 2.5000 m · alpha 1.00");
  EXPECT_EQ(describePixel(depth, plane(0), plane(0), 0, 0), "nothing here");
}

TEST(Picture, KeepsPhotographsAsTheyAreAndReadsThemLinearToo) {
  const Picture p = pictureOf(Image<u8vec3>(1, 1, u8vec3(188, 50, 7)), "photo");
  EXPECT_EQ(displayed(p, 0, {}).pixels[0], u8vec4(188, 50, 7, 255));
  EXPECT_EQ(describePixel(p, 0, 0), "linear 0.5029 0.0319 0.0021 · sRGB 188 50 7");
  EXPECT_GT(displayed(p, 1, {}).pixels[0].x, 188);
}

TEST(Picture, ShowsOneChannelOfDataGreyWithoutEncoding) {
  const Picture p = pictureOf(Image<float>(1, 1, 0.5f), "ao");
  EXPECT_EQ(displayed(p, 2, {}).pixels[0], u8vec4(128, 128, 128, 255));
}

}  // namespace
}  // namespace beam
