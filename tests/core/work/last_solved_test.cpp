// SPDX-License-Identifier: Apache-2.0
// Results of other settings than those in force stay usable, and it is said.
#include "core/work/last_solved.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/file.h"
#include "core/pipeline/runner.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/stages/step_ids.h"
#include "core/work/evaluate.h"
#include "core/work/export_frames.h"
#include "core/work/render_frames.h"
#include "core/work/report.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_project.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kChange = "surface.iterations 100 → 300";

class LastSolvedTest : public ::testing::Test {
 protected:
  void SetUp() override {
    sink_ = addLogSink([this](const LogRecord& r) {
      if (r.level == LogLevel::Warning) warnings_.push_back(r.text);
    });
  }
  void TearDown() override { removeLogSink(sink_); }

  // Solved, then with other settings in force of `key`.
  Project changed(const std::string& key = "surface.iterations", const FieldValue& value = 300) {
    Project project = solvedStandIn(folder_.path(), {.frames = 3});
    project.set(key, value);
    project.save();
    return project;
  }
  static void run(const Project& project, const RunRequest& request) {
    Runner runner;
    runner.start(project, request, makeCpuDevice());
    while (runner.running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  TempDir folder_;
  std::vector<std::string> warnings_;
  int sink_ = 0;
  std::unique_ptr<ComputeDevice> device_ = makeCpuDevice();
  Progress progress_;
};

TEST_F(LastSolvedTest, IsTheSettingsInForceWhereTheySolve) {
  const Project project = solvedStandIn(folder_.path(), {.frames = 3});
  EXPECT_THAT(lastSolved(project, {}, progress_).changes, IsEmpty());
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(LastSolvedTest, IsTheSettingsBeforeAndSaysWhatChanged) {
  const Project project = changed();
  const LastSolved last = lastSolved(project, {.materials = true}, progress_);
  EXPECT_THAT(last.changes, ElementsAre(kChange));
  EXPECT_EQ(last.project.state(kMaterialsStep, FrameIndex{0}), StepState::Done);
  EXPECT_THAT(warnings_, IsEmpty());
  last.tell();
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_THAT(warnings_[0], HasSubstr(kChange));
}

TEST_F(LastSolvedTest, IsRefusedWhereItIsToBeStrict) {
  const Project project = changed();
  const std::string said =
      messageOf(Error::Kind::Data, [&] { lastSolved(project, {.strict = true}, progress_); });
  EXPECT_THAT(said, HasSubstr(kChange));
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(LastSolvedTest, TakesAllFramesFromTheSameSettings) {
  const Project project = changed();
  run(project, {.frames = {FrameIndex{1}}});
  const Project now = Project::open(project.folder(), standInPipeline({.frames = 3}));
  EXPECT_THAT(lastSolved(now, {.frames = "1"}, progress_).changes, IsEmpty());
  EXPECT_THAT(lastSolved(now, {.frames = "all"}, progress_).changes, IsEmpty()) << "some are solved";
  EXPECT_THAT(lastSolved(now, {.frames = "0,2"}, progress_).changes, ElementsAre(kChange));
}

// What is drawn of a frame does not depend on which others are named beside it.
TEST_F(LastSolvedTest, MixesNoFramesInForceWithOnesThatOtherSettingsAloneSolve) {
  const Project project = changed();
  run(project, {.frames = {FrameIndex{1}}});
  const Project now = Project::open(project.folder(), standInPipeline({.frames = 3}));
  const std::string said =
      messageOf(Error::Kind::Data, [&] { lastSolved(now, {.frames = "0-2"}, progress_); });
  EXPECT_THAT(said, AllOf(HasSubstr("frames 000000, 000002 are solved with other settings only"),
                          HasSubstr(kChange)));
}

TEST_F(LastSolvedTest, NamesInOneWarningTheFramesThatOtherSettingsAloneHave) {
  run(changed(), {.frames = {FrameIndex{0}}});
  const Project now = Project::open(folder_ / "capture.beam", standInPipeline({.frames = 3}));
  const LastSolved last = lastSolved(now, {}, progress_);
  EXPECT_THAT(last.left_out, ElementsAre(FrameIndex{1}, FrameIndex{2}));
  last.tell();
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_THAT(warnings_[0], HasSubstr("frames 000001-000002 are left out"));
  const std::string refusal =
      messageOf(Error::Kind::Data, [&] { lastSolved(now, {.strict = true}, progress_); });
  EXPECT_THAT(refusal, AllOf(HasSubstr("000001-000002"), HasSubstr("--strict")));
  EXPECT_NO_THROW(lastSolved(now, {.frames = "0", .strict = true}, progress_));
  EXPECT_THAT(lastSolved(now, {.frames = "0"}, progress_).left_out, IsEmpty()) << "not asked for";
}

TEST_F(LastSolvedTest, NamesFramesThatARunLeftUnrefined) {
  const Project project = solvedStandIn(folder_.path(), {.frames = 3});
  EXPECT_THAT(lastSolved(project, {}, progress_).unfinished, IsEmpty());
  for (const StepId& step : {kMaterialsStep, kRefineStep})
    std::filesystem::remove_all(project.store().folderOf(project.key(step, FrameIndex{1})));
  const Project cut = Project::open(project.folder(), standInPipeline({.frames = 3}));
  const LastSolved last = lastSolved(cut, {}, progress_);
  EXPECT_THAT(last.unfinished, ElementsAre(FrameIndex{1}));
  last.tell();
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_THAT(warnings_[0],
              AllOf(HasSubstr("frame 000001 is fitted and not refined"), HasSubstr("--strict")));
  EXPECT_THAT(messageOf(Error::Kind::Data, [&] { lastSolved(cut, {.strict = true}, progress_); }),
              HasSubstr("000001"));
  EXPECT_NO_THROW(lastSolved(cut, {.frames = "0", .strict = true}, progress_));
  report({cut, folder_ / "cut.html"}, *device_, progress_);
  EXPECT_THAT(readTextFile(folder_ / "cut.html"), HasSubstr("frame 000001 is fitted and not refined"));
}

TEST_F(LastSolvedTest, LeavesOutNoFrameThatNobodySolvedOrAScoutPassed) {
  const Project part = solvedStandIn(folder_.path(), {.frames = 3}, {.frames = {FrameIndex{0}}});
  EXPECT_THAT(lastSolved(part, {}, progress_).left_out, IsEmpty());
  const Project scouted = solvedStandIn(folder_ / "scout", {.frames = 3}, {.every = 2});
  EXPECT_THAT(lastSolved(scouted, {.between = true}, progress_).left_out, IsEmpty());
}

TEST_F(LastSolvedTest, TakesMaterialsOfOtherSettingsOnTheSurfaceInForce) {
  const Project project = changed("materials.iterations", 7);
  const WantedResults wanted{.materials_if_any = true};
  EXPECT_THAT(lastSolved(project, wanted, progress_).changes, ElementsAre("materials.iterations 100 → 7"));
  EXPECT_THAT(lastSolved(project, {}, progress_).changes, IsEmpty()) << "the surface is in force";
  messageOf(Error::Kind::Data,
            [&] { lastSolved(project, {.materials_if_any = true, .strict = true}, progress_); });
}

TEST_F(LastSolvedTest, NamesFramesThatAloneHaveNoMaterials) {
  const Project project = changed("materials.iterations", 7);
  run(project, {.frames = {FrameIndex{1}}});
  const Project now = Project::open(project.folder(), standInPipeline({.frames = 3}));
  const WantedResults wanted{.frames = "1-2", .materials_if_any = true};
  const LastSolved last = lastSolved(now, wanted, progress_);
  EXPECT_THAT(last.bare, ElementsAre(FrameIndex{2}));
  last.tell();
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_THAT(warnings_[0], HasSubstr("frame 000002 is without materials"));
  WantedResults strict = wanted;
  strict.strict = true;
  EXPECT_THAT(messageOf(Error::Kind::Data, [&] { lastSolved(now, strict, progress_); }), HasSubstr("000002"));
}

TEST_F(LastSolvedTest, NamesNoChangeOfMaterialsThatWereNeverSolved) {
  Project project = changed("materials.iterations", 7);
  project.set("materials.iterations", 100);
  project.set("surface.iterations", 300);
  project.save();
  EXPECT_THAT(lastSolved(project, {}, progress_).changes, ElementsAre(kChange));
  EXPECT_THAT(lastSolved(project, {.materials_if_any = true}, progress_).changes, ElementsAre(kChange));
}

TEST_F(LastSolvedTest, ScoresANewSurfaceRatherThanOldMaterials) {
  const Project project = changed();
  run(project, {.until = "surface"});
  const Project now = Project::open(project.folder(), standInPipeline({.frames = 3}));
  EXPECT_THAT(lastSolved(now, {}, progress_).changes, IsEmpty());
  EXPECT_THAT(lastSolved(now, {.materials = true}, progress_).changes, ElementsAre(kChange));
}

TEST_F(LastSolvedTest, ServesPicturesExportsScoresAndTheReportWhichIsMarked) {
  const Project project = changed();
  const RenderFramesRequest pictures{.project = project,
                                     .channels = {"base_color"},
                                     .cameras = "all",
                                     .environments = {},
                                     .out = folder_ / "pictures"};
  EXPECT_EQ(renderFrames(pictures, *newCpuSceneRenderer(*device_), progress_).frames, 3u);
  EXPECT_EQ(exportFrames({project, "all", false, folder_ / "splats"}, progress_).files.size(), 3u);
  EXPECT_THAT(evaluate({project, "all", {}, {}}, *device_, progress_).origin.setting_changes,
              ElementsAre(kChange));
  EXPECT_EQ(report({project, folder_ / "page.html"}, *device_, progress_).frames, 3u);
  EXPECT_THAT(readTextFile(folder_ / "page.html"), HasSubstr(kChange));
  const auto names_it = [](const std::string& warning) { return warning.find(kChange) != std::string::npos; };
  EXPECT_EQ(std::count_if(warnings_.begin(), warnings_.end(), names_it), 4);
}

TEST_F(LastSolvedTest, WarnsOfNothingWhereTheWorkIsRefused) {
  const Project project = changed();
  messageOf(Error::Kind::Usage, [&] {
    exportFrames({project, "all", false, project.folder() / "in"}, progress_);
  });
  messageOf(Error::Kind::Usage, [&] { exportFrames({project, "all", false, ""}, progress_); });
  messageOf(Error::Kind::Data, [&] {
    evaluate({project, "all", folder_ / "none", {}}, *device_, progress_);
  });
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(LastSolvedTest, ChangesNothingInTheProject) {
  const Project project = changed();
  const std::string before = readTextFile(project.folder() / "project.json");
  lastSolved(project, {}, progress_);
  EXPECT_EQ(readTextFile(project.folder() / "project.json"), before);
}

TEST_F(LastSolvedTest, OfAProjectThatNeverSolvedIsTheProject) {
  const Project project = newStandIn(folder_.path());
  EXPECT_THAT(lastSolved(project, {.strict = true}, progress_).changes, IsEmpty());
  messageOf(Error::Kind::Data, [&] { exportFrames({project, "all", false, folder_ / "splats"}, progress_); });
}

}  // namespace
}  // namespace beam::testing
