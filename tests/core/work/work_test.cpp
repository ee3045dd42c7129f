// SPDX-License-Identifier: Apache-2.0
// What both programs call: the outcome says what was made, and what was made is there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/io/splat_ply.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/work/evaluate.h"
#include "core/work/export_frames.h"
#include "core/work/render_frames.h"
#include "core/work/report.h"
#include "tests/core/work/true_copy.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_project.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kFrames = 6, kGaussians = 60;  // of StandInSize

class Work : public ::testing::Test {
 protected:
  static const Project& solved() {
    static const TempDir folder;
    static const Project project = solvedStandIn(folder.path());
    return project;
  }
  RenderFramesRequest pictures() const {
    return {.project = solved(),
            .channels = {"rgb", "depth"},
            .cameras = "all",
            .frames = "0-1",
            .environments = {},
            .world_frame = false,
            .out = out()};
  }
  fs::path out() const { return folder_ / "out"; }
  std::set<std::string> written() const {
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      if (entry.is_regular_file())
        files.insert(entry.path().lexically_relative(folder_.path()).generic_string());
    }
    return files;
  }

  TempDir folder_;
  std::unique_ptr<ComputeDevice> device_ = makeCpuDevice();
  Progress progress_;
};

TEST_F(Work, RenderFramesSaysWhatItDrew) {
  const RenderFramesOutcome outcome = renderFrames(pictures(), *newCpuSceneRenderer(*device_), progress_);
  EXPECT_EQ(outcome.cameras, 4u);
  EXPECT_EQ(outcome.frames, 2u);
  EXPECT_THAT(outcome.interpolated, IsEmpty());
  EXPECT_EQ(written().size(), 2u * 4 * 2);
  EXPECT_TRUE(fs::exists(out() / "rgb/cam0/000000.png"));
  EXPECT_TRUE(fs::exists(out() / "depth/cam3/000001.exr"));
}

TEST_F(Work, RenderFramesRefusesWordsThatChooseNothing) {
  RenderFramesRequest request = pictures();
  request.channels = {"colour"};
  messageOf(Error::Kind::Usage, [&] { renderFrames(request, *newCpuSceneRenderer(*device_), progress_); });
  request = pictures();
  request.cameras = "nobody";
  messageOf(Error::Kind::Usage, [&] { renderFrames(request, *newCpuSceneRenderer(*device_), progress_); });
  request = pictures();
  request.frames = "77";
  messageOf(Error::Kind::Usage, [&] { renderFrames(request, *newCpuSceneRenderer(*device_), progress_); });
  EXPECT_THAT(written(), IsEmpty());
}

TEST_F(Work, ExportFramesNamesItsFiles) {
  const ExportOutcome outcome = exportFrames({solved(), "1,4", false, out()}, progress_);
  EXPECT_THAT(outcome.files, ElementsAre(out() / "frame.000001.ply", out() / "frame.000004.ply"));
  EXPECT_THAT(outcome.interpolated, IsEmpty());
  EXPECT_EQ(written().size(), 2u);
  for (const fs::path& file : outcome.files) EXPECT_EQ(readSplatPly(file).cloud.size(), kGaussians) << file;
}

TEST_F(Work, FramesWhoseNumbersAreTheSameKeepTheirNames) {
  const Project takes = solvedStandIn(folder_ / "shots", {.frames = 3, .name_end = "_v2"});
  EXPECT_THAT(exportFrames({takes, "all", false, out()}, progress_).files,
              ElementsAre(out() / "frame.000000_v2.ply", out() / "frame.000001_v2.ply",
                          out() / "frame.000002_v2.ply"));
}

TEST_F(Work, AFrameOfAScoutIsNamedAsInterpolated) {
  const Project scouted = solvedStandIn(folder_ / "scout", {.frames = 3}, {.every = 2});
  EXPECT_THAT(exportFrames({scouted, "all", false, out()}, progress_).interpolated, ElementsAre("000001"));
  EXPECT_TRUE(fs::exists(out() / "frame.000001.ply"));
}

TEST_F(Work, EvaluateScoresEveryHeldOutPhotograph) {
  const EvaluateOutcome outcome = evaluate({solved(), "all", {}, {}}, *device_, progress_);
  ASSERT_FALSE(outcome.table.empty());
  EXPECT_EQ(outcome.table[0].first, "rgb_held_out");
  EXPECT_EQ(outcome.table[0].second.at("pictures"), kFrames);
  double sum = 0;
  for (const auto& [frame, cameras] : outcome.each) sum += cameras.at("cam3").at("rgb.psnr");
  EXPECT_EQ(outcome.each.size(), static_cast<std::size_t>(kFrames));
  EXPECT_NEAR(outcome.table[0].second.at("psnr"), sum / kFrames, 1e-9);
}

TEST_F(Work, EvaluateAgainstItsOwnPicturesFindsNoFault) {
  makeTrueCopy(solved(), folder_ / "set", *device_);
  const EvaluateOutcome outcome = evaluate({solved(), "0-1", folder_ / "set", {}}, *device_, progress_);
  const std::map<std::string, Scores> rows(outcome.table.begin(), outcome.table.end());
  for (const char* map : {"rgb", "base_color", "ao", "roughness"}) {
    EXPECT_EQ(rows.at(map).at("psnr"), 100) << map;
    EXPECT_NEAR(rows.at(map).at("ssim"), 1, 1e-9) << map;
  }
  EXPECT_LT(rows.at("normal").at("angle_deg"), 0.01);
  EXPECT_EQ(rows.at("depth").at("mae_mm"), 0);
  EXPECT_LT(rows.at("mesh").at("chamfer_mm"), 1e-3);
}

TEST_F(Work, EvaluateWithoutHeldOutCamerasSaysSo) {
  const Project project = solvedStandIn(folder_ / "p", {.cameras = 1, .frames = 1});
  messageOf(Error::Kind::Data, [&] {
    evaluate({project, "all", folder_ / "nowhere", {}}, *device_, progress_);
  });
}

TEST_F(Work, AnEvaluationIsKeptInTheProject) {
  const Project project = solvedStandIn(folder_ / "p", {.frames = 2});
  const EvaluateOutcome outcome = evaluate({project, "all", {}, {}}, *device_, progress_);
  const fs::path means = project.folder() / kEvaluationFile,
                 frames = project.folder() / kEvaluationFramesFile;
  EXPECT_FALSE(fs::exists(means));
  keepEvaluation(project, outcome);
  EXPECT_EQ(readTextFile(means), scoreJson(outcome.table, outcome.origin) + "\n");
  EXPECT_EQ(readTextFile(frames), scoreJson(outcome.table, outcome.each, outcome.origin) + "\n");
}

TEST_F(Work, ReportWritesOnePageOfAllFrames) {
  const ReportOutcome outcome = report({solved(), folder_ / "page.html"}, *device_, progress_);
  EXPECT_EQ(outcome.frames, static_cast<std::size_t>(kFrames));
  EXPECT_EQ(outcome.solved, outcome.frames);
  EXPECT_THAT(outcome.findings, IsEmpty());
  EXPECT_THAT(written(), ElementsAre("page.html"));
  EXPECT_THAT(readTextFile(folder_ / "page.html"), HasSubstr("data:image/jpeg;base64,"));
}

TEST_F(Work, ReportOfNothingIsRefused) {
  const Project project = newStandIn(folder_ / "p");
  const auto refused = [&](const Project& p) {
    const std::string said = messageOf(Error::Kind::Data, [&] {
      report({p, folder_ / "page.html"}, *device_, progress_);
    });
    EXPECT_THAT(said, HasSubstr("no frame is solved yet"));
    EXPECT_FALSE(fs::exists(folder_ / "page.html"));
  };
  refused(project);
  refused(solvedAgain(project, {}, {.until = "capture"}));
}

}  // namespace
}  // namespace beam::testing
