// SPDX-License-Identifier: Apache-2.0
// What is said of cameras that were left out of the fit, and of the loss.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/method/left_out.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

ScreenedView late(double figure) {
  return {"cam3", ScreenKind::Outline, figure,
          "contradicts by " + std::to_string(static_cast<int>(figure * 100))};
}

ViewScore scored(const char* camera, double psnr, bool held_out = false, bool left_out = false) {
  ViewScore v;
  v.camera = camera;
  v.score.psnr = psnr;
  v.held_out = held_out;
  v.left_out = left_out;
  return v;
}

TEST(LeftOut, FramesOfACameraAreToldAsRangesWithTheMomentThatTheScoresKnow) {
  const std::vector<ScreenedFrame> frames = {
      {"f3", 3, {late(0.02)}}, {"f4", 4, {late(0.05)}}, {"f5", 5, {}}, {"f6", 6, {late(0.03)}}};
  const std::vector<LeftOutCamera> found = collectLeftOut(frames);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(toText(found[0], {}), "camera cam3 in frames f3-f4, f6: contradicts by 5");
  const std::vector<Defect> defects = {
      {DefectKind::Late, "cam2", {}, 1, "is 1 frame late: ..."},
      {DefectKind::Late, "cam3", {}, 3, "is 3 frames late: its photographs differ ..."}};
  EXPECT_EQ(toText(found[0], defects),
            "camera cam3 in frames f3-f4, f6: contradicts by 5; it is 3 frames late");
}

TEST(LeftOut, TheLossComparesFramesAndSaysWhatIsNotKnown) {
  const std::vector<ViewScore> all = {scored("a", 30), scored("b", 32), scored("t", 28, true)},
                               fewer = {scored("a", 31), scored("b", 9, false, true), scored("t", 26, true)};
  const std::vector<ScoredFrame> frames = {{"f0", 0, all, {}}, {"f1", 1, fewer, {}}};
  const LeftOutLoss loss = lossOf(frames);
  EXPECT_EQ(loss.least_fitted, 1);
  EXPECT_EQ(loss.of, 2);
  EXPECT_DOUBLE_EQ(loss.incomplete.fitted, 31);
  EXPECT_DOUBLE_EQ(loss.complete.fitted, 31);
  EXPECT_THAT(toText(loss), HasSubstr("1 of 2 views"));
  EXPECT_THAT(toText(loss), HasSubstr("-2.00 dB"));
  EXPECT_THAT(toText(lossOf(std::span(frames).subspan(1))), HasSubstr("none of this take to compare with"));
  EXPECT_THAT(toText(lossOf(std::span(frames).first(1))), IsEmpty());
}

TEST(LeftOut, AGainIsNotCalledALoss) {
  const auto told = [](double incomplete, double complete) {
    const std::vector<ViewScore> all = {scored("a", 30), scored("b", 32), scored("t", complete, true)},
                                 fewer = {scored("a", 31), scored("b", 9, false, true),
                                          scored("t", incomplete, true)};
    return toText(lossOf(std::vector<ScoredFrame>{{"f0", 0, all, {}}, {"f1", 1, fewer, {}}}));
  };
  EXPECT_THAT(told(28.09, 28), HasSubstr("The held-out views show no loss: +0.09 dB"));
  EXPECT_THAT(told(27.999, 28), HasSubstr("no loss: +0.00 dB"));
  EXPECT_THAT(told(27.9, 28), HasSubstr("The loss shows in the held-out views: -0.10 dB"));
}

TEST(LeftOut, ACameraWithoutAPictureCountsAsLeftOut) {
  const std::vector<ViewScore> all = {scored("a", 30), scored("b", 32), scored("t", 28, true)},
                               fewer = {scored("a", 31), scored("t", 27, true)};
  const LeftOutLoss loss =
      lossOf(std::vector<ScoredFrame>{{"f0", 0, all, {}, 0}, {"f1", 1, fewer, {"b"}, 1}});
  EXPECT_EQ(loss.of, 2);
  EXPECT_EQ(loss.complete.frames, 1);
  EXPECT_THAT(toText(loss), HasSubstr("-1.00 dB"));
}

TEST(LeftOut, WithoutHeldOutCamerasNoFigureIsMadeUp) {
  const std::vector<ViewScore> all = {scored("a", 30), scored("b", 32)},
                               fewer = {scored("a", 33), scored("b", 9, false, true)};
  const std::vector<ScoredFrame> frames = {{"f0", 0, all, {}}, {"f1", 1, fewer, {}}};
  const std::string text = toText(lossOf(frames));
  EXPECT_THAT(text, HasSubstr("--hold-out"));
  EXPECT_THAT(text, Not(HasSubstr("The loss shows")));
}

}  // namespace
}  // namespace beam::testing
