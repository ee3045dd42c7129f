// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/take_survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const SurveyLane& laneOf(const TakeSurvey& survey, const std::string& stage) {
  for (const SurveyLane& lane : survey.lanes) {
    if (lane.stage == stage) return lane;
  }
  throw Error(Error::Kind::Bug, "no lane " + stage);
}

RunRequest frameOnly(int frame) {
  RunRequest request;
  request.frames = {FrameIndex{frame}};
  return request;
}

// The survey says of every stage and frame what Project says; Stale is its own word for some that are to do.
void expectSameAsProject(const Project& project, const TakeSurvey& survey) {
  for (const SurveyLane& lane : survey.lanes) {
    for (std::size_t f = 0; f < lane.cells.size(); ++f) {
      const StepState state = project.stageState(lane.stage, FrameIndex{static_cast<std::int32_t>(f)});
      const CellState cell = lane.cells[f];
      EXPECT_EQ(state == StepState::Done, cell == CellState::Done) << lane.stage << " " << f;
      EXPECT_EQ(state == StepState::Running, cell == CellState::Running) << lane.stage << " " << f;
      EXPECT_EQ(state == StepState::Failed, cell == CellState::Failed) << lane.stage << " " << f;
      EXPECT_EQ(state == StepState::Blocked, cell == CellState::Blocked) << lane.stage << " " << f;
    }
  }
}

TEST(TakeSurvey, SaysWhatProjectSaysBeforeDuringAndAfterARun) {
  FakeHouse house;
  Project project = house.newProject();
  TakeSurveyor surveyor;
  EXPECT_THAT(laneOf(surveyor.survey(project), "surface").cells, Each(CellState::Empty));
  house.hooks.at_step = [&](const StepId& step, StepContext& c) {
    if (step != "surface.fit"_step || c.frame.value != 1) return;
    const TakeSurvey during = surveyor.survey(project);
    EXPECT_THAT(laneOf(during, "surface").cells,
                ElementsAre(CellState::Done, CellState::Running, CellState::Empty));
    expectSameAsProject(project, during);
  };
  RunRequest first_two;
  first_two.frames = {FrameIndex{0}, FrameIndex{1}};
  house.finish(project, first_two);
  const TakeSurvey after = surveyor.survey(project);
  EXPECT_THAT(laneOf(after, "materials").cells,
              ElementsAre(CellState::Done, CellState::Done, CellState::Empty));
  expectSameAsProject(project, after);
}

TEST(TakeSurvey, TellsStaleFromNeverMadeAndForgivesSettingsThatComeBack) {
  FakeHouse house;
  Project project = house.newProject();
  house.finish(project, frameOnly(1));
  TakeSurveyor surveyor;
  surveyor.survey(project);
  project.set("materials.iterations", 11);
  const TakeSurvey changed = surveyor.survey(project);
  EXPECT_THAT(laneOf(changed, "surface").cells,
              ElementsAre(CellState::Empty, CellState::Done, CellState::Empty));
  EXPECT_THAT(laneOf(changed, "materials").cells,
              ElementsAre(CellState::Empty, CellState::Stale, CellState::Empty));
  project.reset("materials.iterations");
  EXPECT_EQ(laneOf(surveyor.survey(project), "materials").cells[1], CellState::Done);
}

TEST(TakeSurvey, KeepsWhyAFrameFailed) {
  FakeHouse house;
  Project project = house.newProject();
  house.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step == "surface.refine"_step && c.frame.value == 2) throw Error(Error::Kind::Data, "too dark");
  };
  house.finish(project);
  const TakeSurvey survey = TakeSurveyor().survey(project);
  const SurveyLane& surface = laneOf(survey, "surface");
  EXPECT_THAT(surface.cells, ElementsAre(CellState::Done, CellState::Done, CellState::Failed));
  EXPECT_THAT(surface.notes[2], HasSubstr("too dark"));
  EXPECT_TRUE(surface.notes[1].empty());
}

TEST(TakeSurvey, TellsFramesThatAStageIsNotForAndFollowsTheTakes) {
  FakeHouse house(fakeStagesWithTakes());
  Project project = house.newProject();
  RunRequest first_two;
  first_two.frames = {FrameIndex{0}, FrameIndex{1}};
  house.finish(project, first_two);
  project.readTakesAgain();
  TakeSurveyor surveyor;
  const TakeSurvey survey = surveyor.survey(project);
  EXPECT_THAT(laneOf(survey, "track").cells,
              ElementsAre(CellState::Done, CellState::Done, CellState::NotNeeded));
  EXPECT_THAT(laneOf(survey, "surface").cells,
              ElementsAre(CellState::Done, CellState::Done, CellState::Empty));
  project.changeTakes([](const auto&) { return std::vector<Take>{}; });
  const TakeSurvey alone = surveyor.survey(project);
  EXPECT_THAT(laneOf(alone, "track").cells, Each(CellState::NotNeeded));
  EXPECT_THAT(laneOf(alone, "surface").cells,
              ElementsAre(CellState::Done, CellState::Stale, CellState::Empty));
}

TEST(TakeSurvey, AFrameSolvedAsALeadHasNothingOfItsOwn) {
  FakeHouse house(fakeStagesWithTakes());
  house.frame_names = {"0", "1", "2", "3"};
  Project project = house.newProject();
  RunRequest last_two;
  last_two.frames = {FrameIndex{2}, FrameIndex{3}};
  last_two.overlap = 2;
  house.finish(project, last_two);
  project.readTakesAgain();
  EXPECT_THAT(laneOf(TakeSurveyor().survey(project), "surface").cells,
              ElementsAre(CellState::Done, CellState::Empty, CellState::Done, CellState::Done))
      << "the first of them is what it would be alone";
}

TEST(TakeSurvey, BlockedLanesSayWhatTheyNeed) {
  FakeHouse house;
  house.has_panorama = false;
  const TakeSurvey survey = TakeSurveyor().survey(house.newProject());
  EXPECT_THAT(laneOf(survey, "materials").cells, Each(CellState::Blocked));
  EXPECT_THAT(laneOf(survey, "materials").blocked_reason, HasSubstr("panorama"));
}

TEST(TakeSurvey, DrawsScoresAsCurvesWithGaps) {
  FakeHouse house;
  Project project = house.newProject();
  house.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step == "surface.fit"_step) c.scores["loss"] = 0.5 + c.frame.value;
  };
  for (const int frame : {0, 2}) house.finish(project, frameOnly(frame));
  const TakeSurvey survey = TakeSurveyor().survey(project);
  const SurveyCurve* loss = survey.curve("surface.fit.loss");
  ASSERT_NE(loss, nullptr);
  EXPECT_EQ(loss->values[0], 0.5);
  EXPECT_TRUE(std::isnan(loss->values[1]));
  EXPECT_EQ(loss->values[2], 2.5);
  EXPECT_NE(survey.curve("surface.fit.seconds"), nullptr);
  EXPECT_EQ(survey.curve("surface.fit.beauty"), nullptr);
}

TEST(TakeSurvey, StampsOfFramesChangeWithTheirResultsAlone) {
  FakeHouse house;
  Project project = house.newProject();
  TakeSurveyor surveyor;
  const TakeSurvey before = surveyor.survey(project);
  EXPECT_THAT(before.stamps, Each(Digest{}));
  RunRequest surface = frameOnly(1);
  surface.until = "surface";
  house.finish(project, surface);
  const TakeSurvey half = surveyor.survey(project);
  EXPECT_EQ(half.stamps[0], before.stamps[0]);
  EXPECT_NE(half.stamps[1], before.stamps[1]);
  house.finish(project, frameOnly(1));
  EXPECT_NE(surveyor.survey(project).stamps[1], half.stamps[1]);
}

TEST(TakeSurvey, AResultThatGoesOrLosesAFileIsNotDone) {
  FakeHouse house;
  Project project = house.newProject();
  house.finish(project);
  TakeSurveyor surveyor;
  surveyor.survey(project);
  std::filesystem::remove_all(*project.result("materials.bake"_step, FrameIndex{0}));
  EXPECT_EQ(laneOf(surveyor.survey(project), "materials").cells[0], CellState::Empty);
  std::filesystem::remove(*project.result("materials.bake"_step, FrameIndex{1}) / "data.txt");
  EXPECT_NE(laneOf(TakeSurveyor().survey(project), "materials").cells[1], CellState::Done);
}

TEST(TakeSurvey, SeesChangedPicturesWhenToldToLookAgain) {
  FakeHouse house;
  Project project = house.newProject();
  house.finish(project);
  TakeSurveyor surveyor;
  surveyor.survey(project);
  house.frames->changed[{0, 1}] = 200;
  surveyor.forgetKeys();
  EXPECT_THAT(laneOf(surveyor.survey(project), "surface").cells,
              ElementsAre(CellState::Done, CellState::Stale, CellState::Done));
}

}  // namespace
}  // namespace beam::testing
