// SPDX-License-Identifier: Apache-2.0
// Cameras that move: what keys say holds there, nothing jumps between them, and a turn keeps the subject's
// place.
#include "core/scene/camera_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/base/error.h"
#include "core/io/camera_track_json.h"

namespace beam {
namespace {

constexpr ivec2 kSize(400, 300);

CameraKey key(double time_s, const dvec3& position_m, const char* easing = "spline") {
  return {.time_s = time_s, .position_m = position_m, .target_m = {0, 1, 0}, .easing = easing};
}

CameraTrack around() {
  return {{key(0, {0, 1, 3}), key(1, {3, 1.5, 0}), key(3, {0, 2, -3}), key(4, {-2, 1, -1})}};
}

dvec2 seenAt(const Camera& c, const dvec3& x_m) { return project(c.intrinsics, c.camera_from_world * x_m); }

TEST(CameraTrack, LooksAtItsTargetFromItsPosition) {
  const CameraTrack track = around();
  for (const CameraKey& k : track.keys) {
    const Camera c = cameraAt(track, k.time_s, kSize);
    EXPECT_NO_THROW(validate(c, "path"));
    EXPECT_LT(glm::distance(centerOf(c), k.position_m), 1e-12);
    EXPECT_LT(glm::distance(seenAt(c, k.target_m), dvec2(200, 150)), 1e-9);
    EXPECT_LT(seenAt(c, k.target_m + dvec3(0, 0.2, 0)).y, 150) << "up is up";
  }
}

TEST(CameraTrack, SeesAsHighAsItsFieldOfViewSays) {
  CameraTrack track{{key(0, {0, 1, 3})}};
  track.keys[0].fov_deg = 60;
  const Camera c = cameraAt(track, 0, kSize);
  EXPECT_NEAR(seenAt(c, {0, 1 + 3 * std::tan(glm::radians(30.0)), 0}).y, 0, 1e-9);
  EXPECT_GT(seenAt(c, {0.1, 1, 0}).x, 200) << "+X is on the right of who looks along -Z";
  track.keys[0].roll_deg = 90;  // counter-clockwise from behind: what was above is on the right
  EXPECT_GT(seenAt(cameraAt(track, 0, kSize), {0, 1.1, 0}).x, 207);
}

TEST(CameraTrack, GoesThroughItsKeysWithoutAKink) {
  const CameraTrack track = around();
  constexpr double kStep = 1e-5;
  for (std::size_t i = 1; i + 1 < track.keys.size(); ++i) {
    const double t = track.keys[i].time_s;
    const auto at = [&](double time_s) { return centerOf(cameraAt(track, time_s, kSize)); };
    const dvec3 before = (at(t) - at(t - kStep)) / kStep, after = (at(t + kStep) - at(t)) / kStep;
    EXPECT_LT(glm::distance(before, after), 1e-3 * glm::length(after));
  }
}

TEST(CameraTrack, OnALineGoesEvenlyAlongIt) {
  const CameraTrack track{{key(0, {-1, 1, 3}), key(1, {0, 1, 3}), key(3, {2, 1, 3})}};
  for (double t = 0; t <= 3; t += 0.125)
    EXPECT_LT(glm::distance(centerOf(cameraAt(track, t, kSize)), dvec3(t - 1, 1, 3)), 1e-9) << t;
}

TEST(CameraTrack, HoldsOutsideOfItsKeysAndStepsAsItIsTold) {
  const CameraTrack track{{key(1, {0, 1, 3}, "linear"), key(2, {2, 1, 3}, "step"), key(4, {2, 3, 3})}};
  const auto at = [&](double t) { return centerOf(cameraAt(track, t, kSize)); };
  EXPECT_LT(glm::distance(at(-5), dvec3(0, 1, 3)), 1e-12);
  EXPECT_LT(glm::distance(at(1.25), dvec3(0.5, 1, 3)), 1e-9);
  EXPECT_LT(glm::distance(at(3.9), dvec3(2, 1, 3)), 1e-9);
  EXPECT_LT(glm::distance(at(9), dvec3(2, 3, 3)), 1e-9);
}

TEST(CameraTrack, TurnsAroundWithTheSubjectInItsPlace) {
  const Camera start = cameraAt({{key(0, {0.3, 1.7, 3})}}, 0, kSize);
  const dvec3 middle(0.2, 0.9, -0.1), above(0.2, 1.9, -0.1);
  for (int i = 0; i <= 8; ++i) {
    const Camera c = turnedAround(start, middle, glm::two_pi<double>() * i / 8);
    EXPECT_NO_THROW(validate(c, "turntable"));
    EXPECT_LT(glm::distance(seenAt(c, middle), seenAt(start, middle)), 1e-9);
    EXPECT_LT(glm::distance(seenAt(c, above), seenAt(start, above)), 1e-9) << "the axis stands";
    EXPECT_NEAR(centerOf(c).y, 1.7, 1e-12);
  }
  const Camera quarter = turnedAround(start, dvec3(0), glm::half_pi<double>());
  EXPECT_LT(glm::distance(centerOf(quarter), dvec3(3, 1.7, -0.3)), 1e-9) << "from +Z towards +X";
}

TEST(CameraTrack, ComesBackFromItsFile) {
  CameraTrack track = around();
  track.keys[1].unknown = R"({"lens":"anamorphic"})";
  track.keys[2].easing = "orbit";  // of a later version
  EXPECT_EQ(parseCameraTrack(toJson(track), "path.json"), track);
  EXPECT_EQ(unknownMembers(track), std::vector<std::string>{"keys[1].lens"});
  ASSERT_EQ(remarks(track).size(), 1u);
  EXPECT_NE(remarks(track)[0].find("keys[2].easing is \"orbit\""), std::string::npos);
}

std::string complaintOf(const std::string& json) {
  try {
    parseCameraTrack(json, "path.json");
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Data);
    return e.what();
  }
  return "none";
}

TEST(CameraTrack, ThatIsNoneIsRefusedByPlace) {
  const std::string head = R"({"format": {"name": "beam-camera-path", "major": 1, "minor": 0}, )";
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_PRED2(has, complaintOf(head + R"("keys": []})"), "keys");
  EXPECT_PRED2(has, complaintOf(head + R"("keys": [{"time_s": 1}, {"time_s": 1}]})"), "keys[1]");
  EXPECT_PRED2(has, complaintOf(head + R"("keys": [{"fov_deg": 180}]})"), "keys[0]: fov_deg");
  EXPECT_PRED2(has, complaintOf(head + R"("keys": [{"position_m": {"x": 0, "y": 1, "z": 0}}]})"), "target");
  EXPECT_PRED2(has, complaintOf(head + R"("keys": [{"position_m": 3}]})"), "position_m");
  EXPECT_PRED2(has, complaintOf(head + R"("keys": [{"position_m": {"x": 1e300}}]})"), "places up to");
  EXPECT_PRED2(has, complaintOf(head + R"("keys": [{"roll_deg": 1e308}]})"), "roll_deg");
  EXPECT_PRED2(has, complaintOf(R"({"format": {"name": "beam-look", "major": 1, "minor": 0}})"),
               "beam-camera-path");
  EXPECT_PRED2(has, complaintOf("[1"), "path.json");
}

}  // namespace
}  // namespace beam
