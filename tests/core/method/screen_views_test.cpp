// SPDX-License-Identifier: Apache-2.0
// Cameras that would spoil a fit, among photographs of a finely striped sphere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/method/compare_outlines.h"
#include "core/method/screen_views.h"
#include "tests/support/sphere_capture.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr SphereCapture kSphere{.cameras = 12, .size_px = 128};

// Stripes two pixels wide, so that there is detail to lose.
void addStripes(FrameView& v) {
  for (int y = 0; y < v.photo.height; ++y) {
    for (int x = 0; x < v.photo.width; ++x) {
      if (v.mask(x, y) == 255 && (x / 2 + y / 2) % 2 == 0) v.photo(x, y) = v.photo(x, y) / u8vec3(2);
    }
  }
}

std::vector<FrameView> goodViews(int cameras = kSphere.cameras) {
  SphereCapture sphere = kSphere;
  sphere.cameras = cameras;
  std::vector<FrameView> views = photographs(sphere);
  for (FrameView& v : views) addStripes(v);
  return views;
}

void blacken(FrameView& v) { std::fill(v.photo.pixels.begin(), v.photo.pixels.end(), u8vec3(2)); }

// Means of 7 x 7 pixels.
void blur(FrameView& v) {
  const FrameView sharp = v;
  for (int y = 3; y + 3 < v.photo.height; ++y) {
    for (int x = 3; x + 3 < v.photo.width; ++x) {
      ivec3 sum(0);
      for (int k = 0; k < 49; ++k) sum += ivec3(sharp.photo(x + k % 7 - 3, y + k / 7 - 3));
      v.photo(x, y) = u8vec3(sum / 49);
    }
  }
}

// The sphere stood higher when this camera looked.
FrameView atAnotherMoment(const FrameView& v, float step_m) {
  SphereCapture moved = kSphere;
  moved.center.y += step_m;
  FrameView late = photographSphere(moved, v.camera, v.name);
  addStripes(late);
  return late;
}

Screening screened(const std::vector<FrameView>& views) { return screenViews(views, {}, Progress()); }

TEST(ScreenViews, AccuseNobodyInAGoodFrame) {
  const Screening found = screened(goodViews());
  EXPECT_THAT(found.suspects, IsEmpty());
  ASSERT_EQ(found.figures.size(), static_cast<std::size_t>(kSphere.cameras));
  for (const ScreenFigures& f : found.figures) {
    EXPECT_GT(f.detail, 0) << f.camera;
    EXPECT_EQ(f.outline, 0) << f.camera;
  }
}

TEST(ScreenViews, NameTheBlackTheBlurredAndTheLateCamera) {
  std::vector<FrameView> views = goodViews();
  blacken(views[2]);
  blur(views[5]);
  views[7] = atAnotherMoment(views[7], 0.1f);
  const Screening found = screened(views);
  ASSERT_EQ(found.suspects.size(), 3u);
  EXPECT_EQ(found.to_leave_out, 3u);
  EXPECT_EQ(found.suspects[0].camera, "cam2");
  EXPECT_EQ(found.suspects[0].kind, ScreenKind::Black);
  EXPECT_EQ(found.suspects[1].camera, "cam7");
  EXPECT_EQ(found.suspects[1].kind, ScreenKind::Outline);
  EXPECT_EQ(found.suspects[2].camera, "cam5");
  EXPECT_EQ(found.suspects[2].kind, ScreenKind::Blurred);
  EXPECT_THAT(found.suspects[2].text, HasSubstr("% of the fine detail"));
}

TEST(ScreenViews, ADarkSceneAccusesNobody) {
  std::vector<FrameView> views = goodViews();
  for (FrameView& v : views) blacken(v);
  EXPECT_THAT(screened(views).suspects, IsEmpty());
  for (FrameView& v : views) std::fill(v.photo.pixels.begin(), v.photo.pixels.end(), u8vec3(0));
  EXPECT_THAT(screened(views).suspects, IsEmpty());
}

TEST(ScreenViews, AShadowSideIsNotBlack) {
  std::vector<FrameView> views = goodViews();
  for (u8vec3& p : views[4].photo.pixels) p = p / u8vec3(6);
  EXPECT_THAT(screened(views).suspects, IsEmpty());
}

TEST(ScreenViews, ASoftSubjectAccusesNobody) {
  std::vector<FrameView> views = goodViews();
  for (FrameView& v : views) blur(v);
  EXPECT_THAT(screened(views).suspects, IsEmpty());
}

// Real masks differ from the outline by a pixel or two.
TEST(ScreenViews, RaggedMasksAccuseNobody) {
  std::vector<FrameView> views = goodViews();
  for (std::size_t c = 0; c < views.size(); ++c) {
    const RandomStream random(3, c);
    const Image<std::uint8_t> clean = views[c].mask;
    for (int y = 2; y + 2 < clean.height; ++y) {
      for (int x = 2; x + 2 < clean.width; ++x) {
        const std::uint64_t at = clean.index(x / 4, y / 4);
        const int dx = static_cast<int>(random.bits(2 * at) % 3) - 1;
        const int dy = static_cast<int>(random.bits(2 * at + 1) % 3) - 1;
        views[c].mask(x, y) = clean(x + dx, y + dy);
      }
    }
  }
  EXPECT_THAT(screened(views).suspects, IsEmpty());
}

TEST(ScreenViews, OutlinesOfTwoLateCamerasAreBothFound) {
  std::vector<FrameView> views = goodViews();
  for (const int c : {3, 8}) views[c] = atAnotherMoment(views[c], 0.1f);
  const Screening found = screened(views);
  ASSERT_EQ(found.suspects.size(), 2u);
  EXPECT_EQ(found.to_leave_out, 2u);
  for (const ScreenedView& s : found.suspects) EXPECT_TRUE(s.camera == "cam3" || s.camera == "cam8");
}

// Level cameras around the sphere; all but the first see what is above its centre.
std::vector<FrameView> portraits() {
  std::vector<FrameView> views;
  for (int i = 0; i < 9; ++i) {
    const double phi = 2 * 3.14159265 * i / 9;
    const dvec3 from = dvec3(kSphere.center) + dvec3(2 * std::cos(phi), 0, 2 * std::sin(phi));
    const Camera camera = cameraLookingAt(from, kSphere.center, kSphere.size_px, 1.4 * kSphere.size_px);
    FrameView v = photographSphere(kSphere, camera, "cam" + std::to_string(i));
    addStripes(v);
    if (i > 0) {
      v.camera.height = v.photo.height = v.mask.height = kSphere.size_px / 2;
      v.photo.pixels.resize(v.photo.pixels.size() / 2);
      v.mask.pixels.resize(v.mask.pixels.size() / 2);
    }
    views.push_back(std::move(v));
  }
  return views;
}

TEST(ScreenViews, WhatOneCameraAloneSeesIsNotContradicted) {
  std::vector<FrameView> views = portraits();
  const Screening found = screened(views);
  EXPECT_THAT(found.suspects, IsEmpty());
  EXPECT_LT(found.figures[0].outline, 0.03);  // rays that the others' lower edge cuts
  views[0] = atAnotherMoment(views[0], 0.1f);
  ASSERT_EQ(screened(views).suspects.size(), 1u);
  EXPECT_EQ(screened(views).suspects[0].camera, "cam0");
}

TEST(ScreenViews, AnEmptyMaskContradictsTheOthers) {
  std::vector<FrameView> views = goodViews();
  std::fill(views[6].mask.pixels.begin(), views[6].mask.pixels.end(), std::uint8_t{0});
  const Screening found = screened(views);
  ASSERT_EQ(found.suspects.size(), 1u);
  EXPECT_EQ(found.suspects[0].camera, "cam6");
  EXPECT_EQ(found.suspects[0].kind, ScreenKind::Outline);
}

TEST(ScreenViews, WithoutMasksOutlinesAreNotJudged) {
  std::vector<FrameView> views = goodViews();
  views[7] = atAnotherMoment(views[7], 0.1f);
  blacken(views[1]);
  for (FrameView& v : views) v.mask = {};
  const Screening found = screened(views);
  ASSERT_EQ(found.suspects.size(), 1u);
  EXPECT_EQ(found.suspects[0].kind, ScreenKind::Black);
}

TEST(ScreenViews, NeverMoreThanAQuarterNorFewerThanThreeAreKept) {
  std::vector<FrameView> views = goodViews(8);
  for (const int c : {0, 3}) blacken(views[c]);
  EXPECT_EQ(screened(views).to_leave_out, 2u);
  blacken(views[5]);
  const Screening three = screened(views);
  EXPECT_EQ(three.suspects.size(), 3u);
  EXPECT_EQ(three.to_leave_out, 0u);
  std::vector<FrameView> few = goodViews(3);
  blacken(few[1]);
  EXPECT_THAT(screened(few).suspects, IsEmpty());
}

TEST(ScreenViews, WhereAllAreTooManyTheBlurredAreKept) {
  std::vector<FrameView> views = goodViews(8);
  for (const int c : {0, 3}) blur(views[c]);
  blacken(views[5]);
  const Screening found = screened(views);
  ASSERT_EQ(found.suspects.size(), 3u);
  EXPECT_EQ(found.suspects[0].camera, "cam5");
  EXPECT_EQ(found.to_leave_out, 1u);
}

TEST(ScreenViews, FiguresAreTheSameForAnyNumberOfThreads) {
  std::vector<FrameView> views = goodViews(6);
  views[3] = atAnotherMoment(views[3], 0.05f);
  const Screening many = screened(views);
  setThreadCount(1);
  const Screening one = screened(views);
  setThreadCount(0);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(one.figures[i].detail, many.figures[i].detail);
    EXPECT_EQ(one.figures[i].outline, many.figures[i].outline);
  }
}

}  // namespace
}  // namespace beam::testing
