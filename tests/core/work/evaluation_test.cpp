// SPDX-License-Identifier: Apache-2.0
// Which results an evaluation is of: what is kept says it, a report marks one of others, and ground truth
// that does not fit is refused before anything is drawn.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/file.h"
#include "core/work/evaluate.h"
#include "core/work/kept_evaluation.h"
#include "core/work/report.h"
#include "core/work/score_words.h"
#include "tests/core/work/true_copy.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_project.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr StandInSize kSize{.frames = 3};

class EvaluationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    sink_ = addLogSink([this](const LogRecord& r) {
      if (r.level == LogLevel::Warning) warnings_.push_back(r.text);
    });
    fs::create_directories(folder_ / "scratch");
    ::setenv("TMPDIR", (folder_ / "scratch").c_str(), 1);
  }
  void TearDown() override {
    ::unsetenv("TMPDIR");
    removeLogSink(sink_);
  }

  EvaluateOutcome evaluated(const Project& project, const std::string& frames = "all") {
    const EvaluateOutcome outcome = evaluate({project, frames, {}, {}}, *device_, progress_);
    keepEvaluation(project, outcome);
    return outcome;
  }
  std::string pageOf(const Project& project, bool strict = false) {
    said_ = report({project, folder_ / "page.html", false, strict}, *device_, progress_);
    return readTextFile(folder_ / "page.html");
  }
  // With other settings in force, and solved with them.
  Project solvedOtherwise(Project project, const RunRequest& request = {}) {
    project.set("surface.iterations", 300);
    project.save();
    return solvedAgain(project, kSize, request);
  }
  // `folder_`/set, the truth of frames 0 and 1 of cam3.
  fs::path truthOf(const Project& project) {
    makeTrueCopy(project, folder_ / "set", *device_);
    return folder_ / "set";
  }
  std::string refused(const Project& project, const fs::path& truth, const fs::path& pictures = {},
                      const std::string& frames = "all") {
    std::string said = messageOf(Error::Kind::Data, [&] {
      evaluate({project, frames, truth, pictures}, *device_, progress_);
    });
    EXPECT_THAT(said, Not(HasSubstr("scratch")));
    return said;
  }

  TempDir folder_;
  std::vector<std::string> warnings_;
  int sink_ = 0;
  ReportOutcome said_;
  std::unique_ptr<ComputeDevice> device_ = makeCpuDevice();
  Progress progress_;
};

TEST_F(EvaluationTest, IsOfTheResultsThatTheReportShows) {
  const Project project = solvedStandIn(folder_.path(), kSize);
  evaluated(project);
  const std::string page = pageOf(project);
  EXPECT_THAT(page, AllOf(HasSubstr("Held-out photographs"), HasSubstr(mapTitle("rgb") + ": PSNR"),
                          Not(HasSubstr("of other results"))));
  EXPECT_THAT(said_.findings, IsEmpty());
  EXPECT_EQ(pageOf(project, true), page);
}

TEST_F(EvaluationTest, OfOtherResultsIsMarkedAndLeftOutWhereItIsToBeStrict) {
  const Project project = solvedStandIn(folder_.path(), kSize);
  evaluated(project);
  const Project now = solvedOtherwise(project);
  const std::string page = pageOf(now);
  EXPECT_THAT(page, AllOf(HasSubstr("Held-out photographs"), HasSubstr("of other results"),
                          HasSubstr("frames 000000, 000001, 000002 were solved anew")));
  EXPECT_THAT(page, Not(HasSubstr(mapTitle("rgb") + ": PSNR"))) << "no curve of what is not shown";
  EXPECT_THAT(said_.findings, ElementsAre(HasSubstr("of other results")));
  EXPECT_THAT(pageOf(now, true), AllOf(Not(HasSubstr("Held-out photographs")), HasSubstr("--strict leaves")));
}

TEST_F(EvaluationTest, OfAnEarlierVersionIsNotTakenForOneOfTheseResults) {
  const Project project = solvedStandIn(folder_.path(), kSize);
  const EvaluateOutcome outcome = evaluated(project);
  writeFileAtomically(project.folder() / kEvaluationFramesFile, scoreJson(outcome.table, outcome.each, {}));
  EXPECT_THAT(pageOf(project), HasSubstr("does not say which results it is of"));
}

TEST_F(EvaluationTest, CurvesAreOfTheFramesThatWereNotSolvedAnew) {
  const Project project = solvedStandIn(folder_.path(), kSize);
  evaluated(project);
  const KeptEvaluation kept = keptEvaluation(project);
  ScoredResults shown = kept.results;
  EXPECT_THAT(otherResultsText(kept, shown), IsEmpty());
  shown["000001"] = "other";
  EXPECT_TRUE(isOf(kept, shown, "000000"));
  EXPECT_FALSE(isOf(kept, shown, "000001"));
  EXPECT_THAT(otherResultsText(kept, shown), HasSubstr("frame 000001 was solved anew"));
}

TEST_F(EvaluationTest, CountsInTheReportWhatIsSolvedOfWhatWasBegun) {
  const Project project = newStandIn(folder_.path(), kSize);
  solvedAgain(project, kSize, {.until = "capture"});
  const Project now = solvedAgain(project, kSize, {.frames = {FrameIndex{1}}, .until = "surface"});
  pageOf(now);
  EXPECT_EQ(said_.solved, 1u);
  EXPECT_EQ(said_.frames, 3u);
}

TEST_F(EvaluationTest, OfOtherPicturesIsNotKeptAndKeepsToItsFrames) {
  const Project project = solvedStandIn(folder_.path(), kSize);
  const fs::path truth = truthOf(project);
  evaluated(project);
  const std::string before = readTextFile(project.folder() / kEvaluationFramesFile);
  const EvaluateOutcome both = evaluate({project, "all", truth, truth / "gt"}, *device_, progress_);
  EXPECT_EQ(both.each.size(), 2u);
  keepEvaluation(project, both);
  EXPECT_EQ(readTextFile(project.folder() / kEvaluationFramesFile), before);
  const EvaluateOutcome one = evaluate({project, "1", truth, truth / "gt"}, *device_, progress_);
  EXPECT_EQ(one.each.size(), 1u);
  EXPECT_TRUE(one.each.contains("000001"));
  EXPECT_THAT(refused(project, truth, truth / "gt", "2"), HasSubstr("none of the frames 000002"));
}

TEST_F(EvaluationTest, OfOtherPicturesNeedsGroundTruth) {
  const Project project = solvedStandIn(folder_.path(), kSize);
  EXPECT_THAT(messageOf(Error::Kind::Usage,
                        [&] {
                          evaluate({project, "all", {}, folder_.path()}, *device_, progress_);
                        }),
              HasSubstr("--ground-truth"));
}

TEST_F(EvaluationTest, SaysThatLayersAreNotRead) {
  const Project project = solvedStandIn(folder_.path(), kSize);
  const fs::path truth = truthOf(project), pictures = folder_ / "pictures";
  fs::create_directories(pictures / "layers/cam3");
  fs::copy(truth / "gt/mesh", pictures / "mesh", fs::copy_options::recursive);
  EXPECT_THAT(refused(project, truth, pictures), AllOf(HasSubstr("layers"), HasSubstr("without --layers")));
  fs::copy(truth / "gt/rgb", pictures / "rgb", fs::copy_options::recursive);
  EXPECT_FALSE(evaluate({project, "all", truth, pictures}, *device_, progress_).table.empty());
  EXPECT_THAT(warnings_, Contains(HasSubstr("layers")));
}

TEST_F(EvaluationTest, GroundTruthOfOtherCamerasFramesOrSizesIsRefusedBeforeTheWork) {
  const Project project = solvedStandIn(folder_.path(), kSize);
  const fs::path truth = truthOf(project);
  const std::string description = readTextFile(truth / "dataset.json");
  const auto describe = [&](const char* camera, const char* frame) {
    writeFileAtomically(
        truth / "dataset.json",
        fmt::format(R"({{"test_cameras": ["{}"], "frame_names": ["{}"], "gt_frames": ["{}"]}})", camera,
                    frame, frame));
  };
  describe("north", "000000");
  EXPECT_THAT(refused(project, truth), HasSubstr((truth).string()));
  describe("cam3", "shot_7");
  EXPECT_THAT(refused(project, truth), AllOf(HasSubstr(truth.string()), HasSubstr("it has shot_7")));
  describe("cam2", "000000");
  fs::remove_all(truth / "gt/mesh");
  EXPECT_THAT(refused(project, truth), HasSubstr("gt/rgb/cam2/000000.png"));
  writeFileAtomically(truth / "dataset.json", description);
  const Project small = solvedStandIn(folder_ / "small", {.frames = 3, .size_px = 48});
  EXPECT_THAT(refused(small, truth), AllOf(HasSubstr((truth / "gt/mask/cam3/000000.png").string()),
                                           HasSubstr("expected 48 x 48"), HasSubstr("found 96 x 96")));
  fs::remove(truth / "gt/mask/cam3/000001.png");
  EXPECT_THAT(refused(project, truth), HasSubstr("gt/mask/cam3/000001.png"));
}

}  // namespace
}  // namespace beam::testing
