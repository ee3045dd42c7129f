// SPDX-License-Identifier: Apache-2.0
// Why a result is not there any more, and which settings there were before.
#include "core/pipeline/pending_reason.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/pipeline/project_report.h"
#include "core/pipeline/setting_changes.h"
#include "core/pipeline/settings_report.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr FrameIndex kFirst{0}, kSecond{1}, kLast{2};

std::vector<std::string> reasonsOf(const Project& project, const StepId& step, FrameIndex frame) {
  return PendingReasons(project).of(step, frame);
}

TEST(PendingReasons, AreNoneOfWhatWasNeverComputedAndOfWhatIsThere) {
  FakeHouse house;
  const Project project = house.newProject();
  EXPECT_THAT(reasonsOf(project, "surface.fit"_step, kFirst), IsEmpty());
  house.finish(project);
  EXPECT_THAT(reasonsOf(project, "surface.fit"_step, kFirst), IsEmpty());
  EXPECT_THAT(statusText(project), Not(HasSubstr("because")));
}

TEST(PendingReasons, NameTheSettingThatChangedWithBothValues) {
  FakeHouse house;
  Project project = house.newProject();
  house.finish(project);
  project.set("surface.iterations", 7);
  EXPECT_THAT(reasonsOf(project, "surface.seed"_step, kFirst), ElementsAre("surface.iterations 10 → 7"));
  EXPECT_THAT(statusText(project), HasSubstr("because surface.iterations 10 → 7\n"));
  EXPECT_THAT(statusJson(project), HasSubstr("surface.iterations 10 → 7"));
  project.set("surface.iterations", 10);
  EXPECT_THAT(reasonsOf(project, "surface.seed"_step, kFirst), IsEmpty());
}

TEST(PendingReasons, OfWhatBuildsOnAnotherAreTheOther) {
  FakeHouse house;
  Project project = house.newProject();
  house.finish(project);
  project.set("surface.refine.normal_weight", 0.5);
  EXPECT_THAT(reasonsOf(project, "surface.fit"_step, kFirst), IsEmpty());
  EXPECT_THAT(reasonsOf(project, "materials.bake"_step, kFirst),
              ElementsAre("surface.refine.normal_weight 0.03 → 0.5"));
  project.set("materials.iterations", 4);
  EXPECT_THAT(reasonsOf(project, "materials.bake"_step, kFirst),
              ElementsAre("materials.iterations 10 → 4", "surface.refine.normal_weight 0.03 → 0.5"));
}

TEST(PendingReasons, NameThePictureThatChangedInItsFrameAlone) {
  FakeHouse house;
  const Project project = house.newProject();
  house.finish(project);
  house.frames->changed[{1, 1}] = 200;
  project.forgetKeys();
  EXPECT_THAT(reasonsOf(project, "surface.seed"_step, kSecond), ElementsAre("right changed"));
  EXPECT_THAT(reasonsOf(project, "surface.seed"_step, kFirst), IsEmpty());
}

TEST(PendingReasons, CountWhatWouldBeALongListOfPictures) {
  FakeHouse house;
  const Project project = house.newProject();
  house.finish(project);
  for (int view = 0; view < 3; ++view) house.frames->changed[{view, 0}] = 201 + view;
  project.forgetKeys();
  EXPECT_THAT(reasonsOf(project, "surface.seed"_step, kFirst), SizeIs(3));
}

TEST(PendingReasons, TellThatAFrameHasAnotherPlaceInItsTake) {
  FakeHouse house(fakeStagesWithTakes());
  Project project = house.newProject();
  house.finish(project);
  project.readTakesAgain();
  project.splitTake(project.takeOf(kLast), kLast);
  EXPECT_THAT(reasonsOf(project, "surface.refine"_step, kLast),
              ::testing::Contains("now the first frame of its take"));
  EXPECT_THAT(reasonsOf(project, "surface.refine"_step, kFirst), IsEmpty());
}

TEST(PendingReasons, NameTheFrameThatIsBuiltOnAndNotItsPictures) {
  FakeHouse house(fakeStagesWithTakes());
  Project project = house.newProject();
  RunRequest scout;
  scout.every = 2;
  house.finish(project, scout);
  project.readTakesAgain();
  const FrameIndex second{2};
  ASSERT_EQ(project.takeOf(second).before(second), FrameIndex{0});
  project.changeTakes([](const std::vector<Take>&) { return std::vector<Take>{{{0}, kLast, 1}}; });
  project.forgetKeys();
  EXPECT_THAT(reasonsOf(project, "surface.refine"_step, second),
              ::testing::Contains("frame 001 is built on, before it was frame 000"));
}

TEST(PendingReasons, ReachLaterFramesOfATake) {
  FakeHouse house(fakeStagesWithTakes());
  Project project = house.newProject();
  house.finish(project);
  project.readTakesAgain();
  house.frames->changed[{0, 0}] = 99;
  project.forgetKeys();
  EXPECT_THAT(reasonsOf(project, "surface.refine"_step, kLast), ElementsAre("left changed"));
}

TEST(SettingChanges, AreThoseThatChangeResults) {
  FakeHouse house;
  Project project = house.newProject();
  const Project before = project;
  project.set("surface.iterations", 7);
  project.set("surface.batch", 5);
  project.setHoldOut({"left"});
  EXPECT_THAT(settingChanges(before, project),
              ElementsAre("surface.iterations 10 → 7", "held-out cameras none → left"));
}

TEST(EarlierVersions, AreTheNewestFirstAndNoneTwice) {
  FakeHouse house;
  Project project = house.newProject();
  for (const int iterations : {20, 30, 20, 40}) {
    project.set("surface.iterations", iterations);
    project.save();
  }
  std::vector<int> found;
  for (const Project& version : earlierVersions(project))
    found.push_back(std::get<int>(version.value("surface.iterations")));
  EXPECT_THAT(found, ElementsAre(20, 30, 10));
}

TEST(EarlierVersions, HaveTheOneBeforeThoughTheFolderWasEmptied) {
  FakeHouse house;
  Project project = house.newProject();
  std::filesystem::remove_all(project.folder() / "history");
  project.set("surface.iterations", 20);
  project.save();
  ASSERT_EQ(earlierVersions(project).size(), 1u);
  EXPECT_EQ(std::get<int>(earlierVersions(project)[0].value("surface.iterations")), 10);
}

TEST(EarlierVersions, HaveTheKeysThatTheirResultsHave) {
  FakeHouse house;
  Project project = house.newProject();
  house.finish(project);
  const Digest key = project.key("materials.bake"_step, kFirst);
  project.set("surface.iterations", 7);
  project.setHoldOut({"left"});
  project.save();
  const std::vector<Project> versions = earlierVersions(project);
  ASSERT_FALSE(versions.empty());
  EXPECT_EQ(versions[0].key("materials.bake"_step, kFirst), key);
  EXPECT_NE(project.key("materials.bake"_step, kFirst), key);
}

TEST(SettingsReport, SaysWhatEachPresetSaysAndWhereAValueComesFrom) {
  FakeHouse house;
  EXPECT_THAT(stagesText(*house.setup),
              HasSubstr("surface.iterations: default 10 (draft 3; 1 to 1,000)\n      Steps."))
      << "nothing is in force without a project";
  Project project = house.newProject();
  project.setPreset("draft");
  project.set("surface.solver", std::string("fancy"));
  EXPECT_THAT(stagesText(*house.setup, &project),
              AllOf(HasSubstr("surface.iterations = 3 (preset draft; default 10; draft 3; 1 to 1,000)"),
                    HasSubstr("surface.solver = fancy (set; default plain; plain, fancy)"),
                    HasSubstr("materials.iterations = 10 (default; ")));
  EXPECT_THAT(stagesJson(*house.setup, &project),
              AllOf(HasSubstr(R"("value": 3)"), HasSubstr(R"("from": "preset draft")"),
                    HasSubstr(R"("from": "set")")));
}

}  // namespace
}  // namespace beam::testing
