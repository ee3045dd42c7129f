// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/lost_capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/pipeline/take_survey.h"
#include "tests/core/pipeline/fake_pipeline.h"
#include "tests/support/message_of.h"

namespace beam::testing {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A solved project whose capture was moved to "elsewhere".
class LostCapture : public ::testing::Test {
 protected:
  LostCapture() {
    house.frame_names = {"f8", "f9", "f10"};
    house.hooks.at_step = [](const StepId& step, StepContext& c) {
      if (step == "capture.import"_step) std::ofstream(c.folder / kCamerasFile) << calibrationText(c.capture);
      if (step == "surface.fit"_step) c.scores["loss"] = c.frame.value;
    };
    EXPECT_EQ(house.finish(house.newProject()).outcome, JobOutcome::Done);
    std::filesystem::rename(house.root() / "capture", house.root() / "elsewhere");
  }
  Project lost() {
    Project project = house.open();
    project.lookWithoutCapture();
    return project;
  }
  FakeHouse house;
};

TEST_F(LostCapture, IsSeenWithoutReadingIt) {
  EXPECT_FALSE(house.open().captureIsThere());
  std::filesystem::rename(house.root() / "elsewhere", house.root() / "capture");
  EXPECT_TRUE(house.open().captureIsThere());
}

TEST_F(LostCapture, HasTheFramesAndCamerasThatResultsTell) {
  const Project project = lost();
  EXPECT_THAT(project.capture().frames, ElementsAre("f8", "f9", "f10"));
  ASSERT_EQ(project.capture().views.size(), 3u);
  EXPECT_EQ(project.capture().views[2].name, "top");
  EXPECT_EQ(project.capture().views[2].camera.intrinsics.fx, 50);
  EXPECT_FALSE(project.capture().source->has(ViewIndex{0}, FrameIndex{0}));
}

TEST_F(LostCapture, IsSurveyedAsStaleWithCurvesAndStamps) {
  const TakeSurvey survey = TakeSurveyor().survey(lost());
  ASSERT_EQ(survey.lanes.size(), 4u);
  for (const SurveyLane& lane : survey.lanes) EXPECT_THAT(lane.cells, Each(CellState::Stale)) << lane.stage;
  EXPECT_THAT(survey.lanes[2].blocked_reason, HasSubstr("is gone"));
  ASSERT_NE(survey.curve("surface.fit.loss"), nullptr);
  EXPECT_THAT(survey.curve("surface.fit.loss")->values, ElementsAre(0, 1, 2));
  for (const Digest& stamp : survey.stamps) EXPECT_NE(stamp, Digest{});
  EXPECT_EQ(survey.leftovers[1].size(), 2u) << "fit and refine";
}

TEST_F(LostCapture, MakesNoKeysAndRunsNothing) {
  const Project project = lost();
  const auto before = everythingIn(house.root());
  EXPECT_THAT(dataErrorOf([&] { project.key("surface.fit"_step, FrameIndex{0}); }), HasSubstr("is gone"));
  EXPECT_FALSE(project.result("surface.fit"_step, FrameIndex{0}));
  EXPECT_EQ(project.state("surface.fit"_step, FrameIndex{0}), StepState::Blocked);
  house.hooks.computed.clear();
  const JobFinished finished = house.finish(project);
  EXPECT_EQ(finished.outcome, JobOutcome::Failed);
  EXPECT_THAT(finished.message, HasSubstr("is gone"));
  EXPECT_TRUE(house.hooks.computed.empty());
  EXPECT_EQ(everythingIn(house.root()), before);
}

TEST_F(LostCapture, FoundAgainHasAllItsResults) {
  Project project = lost();
  project.relocateCapture(house.root() / "elsewhere");
  EXPECT_FALSE(project.withoutCapture());
  EXPECT_EQ(project.stageState("materials", FrameIndex{2}), StepState::Done);
  project.save();
  EXPECT_EQ(house.open().captureFolder().filename(), "elsewhere");
}

TEST_F(LostCapture, AnotherOneIsRefusedWithWhatDiffersUnlessItIsMeant) {
  std::filesystem::create_directories(house.root() / "other");
  Project project = lost();
  EXPECT_THAT(dataErrorOf([&] { project.relocateCapture(house.root() / "other"); }),
              HasSubstr("is no capture"));
  std::ofstream(house.root() / "other" / "dataset.json") << "{\"other\": 1}";
  const std::string refused = dataErrorOf([&] { project.relocateCapture(house.root() / "other"); });
  EXPECT_THAT(refused, HasSubstr("other\" is another capture"));
  EXPECT_THAT(refused, HasSubstr((house.root() / "capture").string()));
  EXPECT_THAT(refused, HasSubstr("dataset.json: expected 2 bytes, found 12"));
  EXPECT_TRUE(project.withoutCapture());
  project.relocateCapture(house.root() / "other", true);
  EXPECT_EQ(project.captureFolder().filename(), "other");
}

TEST(NaturalOrder, ComparesRunsOfDigitsAsNumbers) {
  EXPECT_TRUE(naturallyBefore("f9", "f10"));
  EXPECT_FALSE(naturallyBefore("f10", "f9"));
  EXPECT_TRUE(naturallyBefore("a2b1", "a2b03"));
  EXPECT_TRUE(naturallyBefore("a", "a1"));
  EXPECT_FALSE(naturallyBefore("a1", "a1"));
  EXPECT_TRUE(naturallyBefore("01", "1") != naturallyBefore("1", "01"));
}

TEST(CalibrationText, GivesTheCamerasBack) {
  FakeHouse house;
  CaptureSet capture = house.newProject().capture();
  capture.views[1].name = "two words\nand lines";
  capture.views[1].split = Split::Test;
  capture.views[1].camera.camera_from_world.translation_m = {0.1, -2.0 / 3, 1e-17};
  EXPECT_EQ(viewsOfCalibration(calibrationText(capture)), capture.views);
  dataErrorOf([&] { viewsOfCalibration("view 3:lef"); });
}

// The digest is in the key of the import, and with it in all keys: a byte more and nothing is found again.
TEST(CalibrationText, OfAPinholeIsWhatItAlwaysWas) {
  CaptureSet capture;
  capture.views = {{"left", {{50, 50.5, 32, 24}, 64, 48, {dquat(1, 0, 0, 0), {0.25, -1, 2}}}, Split::Train}};
  EXPECT_EQ(calibrationText(capture),
            "view 4:left train 64x48 k 50 50.5 32 24 q 1 0 0 0 t 0.25 -1 2\n"
            "seed points 0 99aa06d3014798d86001c324468d497f 99aa06d3014798d86001c324468d497f\n");
}

TEST(CalibrationText, TellsALensWhereThereIsOne) {
  CaptureSet capture;
  capture.views = {{"left", {{50, 50, 32, 24}, 64, 48, {}}, Split::Train}};
  capture.views[0].camera.lens = {"later", {0.5, -0.125}};
  const std::string text = calibrationText(capture);
  EXPECT_THAT(text, HasSubstr("t 0 0 0 lens later 0.5 -0.125 0 0 0 0 0 0 0 0 0 0\n"));
  EXPECT_THAT(dataErrorOf([&] { viewsOfCalibration(calibrationText(capture)); }),
              HasSubstr("found \"later\""));
  dataErrorOf([&] { viewsOfCalibration("view 4:left train 64x48 k 50 50 32 24 q 1 0 0 0 t 0 0 0 lens\n"); });
  dataErrorOf([&] { viewsOfCalibration("view 4:left train 64x48 k 50 50 32 24 q 1 0 0 0 t 0 0 0 more\n"); });
}

}  // namespace
}  // namespace beam::testing
