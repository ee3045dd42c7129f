// SPDX-License-Identifier: Apache-2.0
// Cameras and moments that do not fit, found on synthetic pictures: a bright bar that walks over a dark wall.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/method/find_defects.h"

namespace beam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kCameras = 6, kFrames = 10;

Image<std::uint8_t> barAt(int x) {
  Image<std::uint8_t> thumb(kThumbSide_px, kThumbSide_px, 40);
  for (int row = 0; row < kThumbSide_px; ++row) {
    for (int i = 0; i < 8; ++i) thumb((x + i + 64) % kThumbSide_px, row) = 200;
  }
  return thumb;
}

ViewScore good(int camera, int moment) {
  ViewScore v;
  v.camera = "cam" + std::to_string(camera);
  v.score = {30, 0.9, 29};
  v.photo_luma = 0.4 + 0.01 * camera + 0.001 * moment;
  v.render_luma = v.photo_luma + 0.01;
  v.photo_sharpness = 0.05 + 0.002 * camera + 0.0001 * moment;
  v.render_sharpness = 0.9 * v.photo_sharpness;
  v.photo_thumb = v.render_thumb = barAt(3 * moment + 5 * camera);
  return v;
}

struct Frame {
  std::string name;
  int index;
  std::vector<ViewScore> views;
  std::vector<std::string> missing;
};

std::vector<Defect> defectsOf(const std::vector<Frame>& frames) {
  std::vector<ScoredFrame> scored;
  for (const Frame& f : frames) scored.push_back({f.name, f.index, f.views, f.missing});
  return findDefects(scored);
}

std::vector<Frame> goodFrames() {
  std::vector<Frame> frames;
  for (int f = 0; f < kFrames; ++f) {
    Frame frame{"frame" + std::to_string(f), f, {}, {}};
    for (int c = 0; c < kCameras; ++c) frame.views.push_back(good(c, f));
    frames.push_back(std::move(frame));
  }
  return frames;
}

TEST(FindDefects, AGoodCaptureHasNone) { EXPECT_TRUE(defectsOf(goodFrames()).empty()); }

TEST(FindDefects, NamesTheDroppedFrames) {
  std::vector<Frame> frames = goodFrames();
  for (const int f : {2, 3}) {
    frames[f].views.erase(frames[f].views.begin() + 4);
    frames[f].missing = {"cam4"};
  }
  const std::vector<Defect> found = defectsOf(frames);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, DefectKind::Missing);
  EXPECT_EQ(found[0].camera, "cam4");
  EXPECT_THAT(found[0].frames, ElementsAre("frame2", "frame3"));
}

TEST(FindDefects, NamesOneBlackPictureAndTheLossItMakes) {
  std::vector<Frame> frames = goodFrames();
  ViewScore& v = frames[5].views[1];
  v.photo_luma = v.photo_sharpness = 0;
  v.photo_thumb = Image<std::uint8_t>(kThumbSide_px, kThumbSide_px);
  v.score.psnr = 6;
  const std::vector<Defect> found = defectsOf(frames);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, DefectKind::Black);
  EXPECT_EQ(found[0].camera, "cam1");
  EXPECT_THAT(found[0].frames, ElementsAre("frame5"));
  EXPECT_DOUBLE_EQ(found[0].psnr_with, 26);
  EXPECT_DOUBLE_EQ(found[0].psnr_without, 30);
}

TEST(FindDefects, NamesABlurredCamera) {
  std::vector<Frame> frames = goodFrames();
  for (Frame& f : frames) f.views[2].photo_sharpness *= 0.4;
  const std::vector<Defect> found = defectsOf(frames);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, DefectKind::Blurred);
  EXPECT_EQ(found[0].camera, "cam2");
  EXPECT_EQ(found[0].frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_NEAR(found[0].figure, 0.4, 0.01);
}

TEST(FindDefects, NamesACameraThatIsThreeFramesLateOrEarly) {
  for (const int lag : {3, -3}) {
    std::vector<Frame> frames = goodFrames();
    for (int f = 0; f < kFrames; ++f) frames[f].views[3].photo_thumb = good(3, f - lag).photo_thumb;
    const std::vector<Defect> found = defectsOf(frames);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, DefectKind::Late);
    EXPECT_EQ(found[0].camera, "cam3");
    EXPECT_EQ(found[0].figure, lag);
    EXPECT_THAT(found[0].text, HasSubstr(lag > 0 ? "3 frames late" : "3 frames early"));
  }
}

TEST(FindDefects, LatenessIsCountedInFramesOfTheCapture) {
  std::vector<Frame> frames = goodFrames();
  for (int f = 0; f < kFrames; ++f) {
    frames[f].views[3].photo_thumb = good(3, f - 2).photo_thumb;
    frames[f].index += 10;
  }
  frames.erase(frames.begin() + 5);
  const std::vector<Defect> found = defectsOf(frames);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].figure, 2);
}

// The renders of the second frame are poor: they fit no photograph of their own moment.
TEST(FindDefects, ATakeOfTwoFramesTellsNothingOfLateness) {
  std::vector<Frame> frames = goodFrames();
  frames.resize(2);
  for (int c = 0; c < kCameras; ++c) frames[1].views[c].render_thumb = good(c, -4).render_thumb;
  for (int c = 0; c < kCameras; ++c) frames[0].views[c].render_thumb = good(c, 1).render_thumb;
  EXPECT_TRUE(defectsOf(frames).empty());
}

TEST(FindDefects, WhereMostCamerasSeemLateNoneIs) {
  for (const int late : {kCameras / 2, kCameras / 2 + 1}) {
    std::vector<Frame> frames = goodFrames();
    for (int f = 0; f < kFrames; ++f) {
      for (int c = 0; c < late; ++c) frames[f].views[c].photo_thumb = good(c, f - 2).photo_thumb;
    }
    EXPECT_EQ(defectsOf(frames).size(), late > kCameras / 2 ? 0u : static_cast<std::size_t>(late));
  }
}

TEST(FindDefects, SayOneFrameAndTwoFrames) {
  for (const int gone : {1, 2}) {
    std::vector<Frame> frames = goodFrames();
    for (int f = 0; f < gone; ++f) {
      frames[f].views.erase(frames[f].views.begin() + 4);
      frames[f].missing = {"cam4"};
    }
    const std::vector<Defect> found = defectsOf(frames);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_THAT(found[0].text, HasSubstr(gone == 1 ? "in 1 of 10 frames; the frame was solved"
                                                   : "in 2 of 10 frames; the frames were solved"));
  }
}

TEST(FindDefects, NamesAFrozenPictureOnlyWhileTheOthersMove) {
  std::vector<Frame> frames = goodFrames();
  const auto freeze = [&](int camera) {
    ViewScore& now = frames[7].views[camera];
    const ViewScore& before = frames[6].views[camera];
    now.photo_luma = before.photo_luma, now.photo_sharpness = before.photo_sharpness;
    now.photo_thumb = before.photo_thumb;
  };
  freeze(0);
  const std::vector<Defect> found = defectsOf(frames);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, DefectKind::Frozen);
  EXPECT_EQ(found[0].camera, "cam0");
  EXPECT_THAT(found[0].frames, ElementsAre("frame7"));
  for (int c = 1; c < kCameras; ++c) freeze(c);
  EXPECT_TRUE(defectsOf(frames).empty());
}

TEST(FindDefects, NamesACameraOfAnotherExposure) {
  std::vector<Frame> frames = goodFrames();
  for (Frame& f : frames) f.views[5].photo_luma *= 1.4;
  const std::vector<Defect> found = defectsOf(frames);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, DefectKind::Exposure);
  EXPECT_EQ(found[0].camera, "cam5");
}

}  // namespace
}  // namespace beam::testing
