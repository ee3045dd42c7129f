// SPDX-License-Identifier: Apache-2.0
// A render that shows nothing scores what a black picture scores; means and worst camera follow the split.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/method/score_views.h"
#include "tests/support/sphere_capture.h"

namespace beam::testing {
namespace {

// One Gaussian behind all cameras.
GaussianCloud nothingToSee() {
  GaussianCloud c;
  c.position_m = {vec3(0, 100, 0)};
  c.rotation = {quat(1, 0, 0, 0)};
  c.scale_m.assign(1, vec3(0.001f));
  c.opacity = {0.5f};
  c.color = ShBlock(1, 3);
  return c;
}

std::vector<ViewScore> scored(const std::vector<FrameView>& views) {
  const auto device = makeCpuDevice(SimdTarget::Scalar);
  Progress progress;
  return scoreViews(views, true, nothingToSee(), *device, progress);
}

TEST(ScoreViews, ABlackRenderScoresWhatABlackPictureDoes) {
  const std::vector<FrameView> views = photographs({});
  const std::vector<ViewScore> scores = scored(views);
  ASSERT_EQ(scores.size(), views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const FrameView& v = views[i];
    Planes photo(v.photo.width, v.photo.height, 3);
    for (std::size_t p = 0; p < photo.planeSize(); ++p) {
      for (int c = 0; c < 3; ++c) photo.plane(c)[p] = v.photo.pixels[p][c] / 255.0f;
    }
    const PictureScore black = scorePicture(Planes(v.photo.width, v.photo.height, 3), photo, v.mask);
    EXPECT_EQ(scores[i].camera, v.name);
    EXPECT_TRUE(scores[i].held_out);
    EXPECT_NEAR(scores[i].score.psnr, black.psnr, 1e-4);
    EXPECT_NEAR(scores[i].score.psnr_mask, black.psnr_mask, 1e-4);
    EXPECT_EQ(scores[i].render_luma, 0);
    EXPECT_GT(scores[i].photo_luma, 0.2);
  }
}

TEST(ScoreViews, AnEmptyMaskCountsEveryPixel) {
  std::vector<FrameView> views = photographs({});
  for (std::uint8_t& m : views[0].mask.pixels) m = 0;
  for (u8vec3& p : views[0].photo.pixels) p = u8vec3(0);
  EXPECT_DOUBLE_EQ(scored(views)[0].score.psnr, 100);
}

TEST(ScoreViews, AViewScoresTheSameAmongMany) {
  std::vector<FrameView> views = photographs({});
  const std::vector<ViewScore> all = scored(views);
  const ViewScore last = scored({views.back()})[0];
  EXPECT_EQ(all.back().score.ssim, last.score.ssim);
  EXPECT_EQ(all.back().photo_thumb.pixels, last.photo_thumb.pixels);
}

// A subject of two pixels: less than a window of SSIM, also where a picture is no larger than that.
TEST(ScoreViews, ATinySubjectAndATinyPictureAreScored) {
  std::vector<FrameView> views = photographs({});
  for (FrameView& v : views) {
    std::fill(v.mask.pixels.begin(), v.mask.pixels.end(), std::uint8_t{0});
    v.mask(v.mask.width / 2, v.mask.height / 2) = v.mask(v.mask.width / 2 + 1, v.mask.height / 2) = 255;
  }
  EXPECT_TRUE(scored(views)[0].score.ssim);
  FrameView& tiny = views[0];
  tiny.photo = Image<u8vec3>(9, 7, u8vec3(90));
  tiny.mask = Image<std::uint8_t>(9, 7, 255);
  tiny.camera.width = 9, tiny.camera.height = 7;
  const ViewScore score = scored({tiny})[0];
  EXPECT_FALSE(score.score.ssim);
  EXPECT_GT(score.score.psnr, 0);
}

TEST(ScoreViews, StopAfterTheLastRender) {
  const auto device = makeCpuDevice(SimdTarget::Scalar);
  std::stop_source stop;
  Progress progress(stop.get_token(), [&](const ProgressReport& r) {
    if (r.done == r.total) stop.request_stop();
  });
  const std::vector<FrameView> views = photographs({});
  EXPECT_THROW(scoreViews(views, true, nothingToSee(), *device, progress), Cancelled);
}

TEST(ScoreViews, MeansAreTakenOverOneSplit) {
  std::vector<ViewScore> scores(3);
  scores[0].score = {20, 0.5, 0}, scores[1].score = {30, 0.9, 0}, scores[2].score = {10, 0.1, 0};
  scores[2].held_out = true;
  const SplitScore train = meanOf(scores, false), test = meanOf(scores, true);
  EXPECT_DOUBLE_EQ(train.mean.psnr, 25);
  EXPECT_EQ(train.n, 2u);
  EXPECT_EQ(train.worst, 0u);
  EXPECT_DOUBLE_EQ(test.mean.psnr, 10);
  EXPECT_EQ(test.worst, 2u);
  EXPECT_EQ(meanOf({}, true).n, 0u);
}

}  // namespace
}  // namespace beam::testing
