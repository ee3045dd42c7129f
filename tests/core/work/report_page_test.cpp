// SPDX-License-Identifier: Apache-2.0
// The report speaks: scores, settings and steps have labels and units, one is not many, and a curve has an
// axis that fits it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "core/stages/step_ids.h"
#include "core/work/report_page.h"
#include "core/work/score_words.h"
#include "core/work/svg_chart.h"

namespace beam::testing {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

std::vector<StageInfo> stages() {
  return {{"track", "Track", "", {{.id = "joints", .title = "Track joints"}}},
          {"surface", "Surface", "", {{.id = "fit", .title = "Fit appearance"}}}};
}

TEST(ScoreWords, HaveALabelAndAUnit) {
  EXPECT_EQ(scoreWords("psnr_train"), (ScoreWords{"PSNR, training views", "dB"}));
  EXPECT_EQ(scoreWords("angle_deg").unit, "degrees");
  EXPECT_EQ(scoreWords("mae_mm").unit, "mm");
  EXPECT_EQ(scoreWords("seconds"), (ScoreWords{"time", "s"}));
  EXPECT_EQ(scoreWords("peak_memory_mb"), (ScoreWords{"peak memory", "MB"})) << "by the end of its name";
  EXPECT_EQ(titleOf(scoreWords("gaussians")), "Gaussians");
}

TEST(ScoreWords, OfACurveSayWhereItComesFrom) {
  const auto title = [](const char* curve) { return titleOf(curveWords(stages(), curve)); };
  EXPECT_EQ(title("surface.fit.psnr"), "Surface, fit appearance: PSNR (dB)");
  EXPECT_EQ(title("track.joints.joints"), "Track joints: number of joints");
  EXPECT_EQ(title("evaluate.mesh.chamfer_mm"), "Evaluation: Mesh: chamfer distance (mm)");
  EXPECT_EQ(title("evaluate.relight_studio_scaled.psnr"), "Evaluation: Relit, studio, scaled: PSNR (dB)");
  EXPECT_EQ(title("nobody.knows.this"), "nobody.knows.this");
  EXPECT_EQ(mapTitle("base_color"), "Base colour");
}

ReportPage pageOf(std::size_t frames) {
  ReportPage page;
  page.project = "take";
  page.stages = stages();
  page.frames_in_capture = frames;
  page.settings = {{"Later frames' iterations", "surface.later.iterations", "10", "iterations"}};
  for (std::size_t f = 0; f < frames; ++f) {
    FrameQuality q;
    q.name = fmt::format("{:06}", f);
    q.scores = {{"surface.fit.gaussians", 400}, {"evaluate.normal.angle_deg", 3.5}};
    q.seconds[kFitStep] = 2;
    page.history.frames.push_back(std::move(q));
  }
  page.history.defects = {{DefectKind::Black, "cam0", {"000000"}, 0, "is black in 1 frame"}};
  return page;
}

TEST(ReportPage, SaysWhatIsMeantAndNotItsKey) {
  const std::string page = toHtml(pageOf(2));
  for (const char* words :
       {"Later frames' iterations", "surface.later.iterations", "iterations</td>", "Surface, fit appearance",
        "Gaussians", "<h3>Evaluation</h3>", "Normal: mean angle to the truth, degrees"})
    EXPECT_THAT(page, HasSubstr(words));
  for (const char* key : {"surface.fit", "angle_deg", "evaluate."}) EXPECT_THAT(page, Not(HasSubstr(key)));
}

TEST(ReportPage, OfOneFrameSaysOne) {
  const std::string page = toHtml(pageOf(1));
  EXPECT_THAT(page, AllOf(HasSubstr("frame solved and scored"), HasSubstr("finding about the capture")));
  EXPECT_THAT(page, Not(HasSubstr("frames solved")));
}

Chart chartOf(const std::vector<double>& values) {
  Chart c{"Title", "dB", {}, {{"s", {}}}, {}};
  for (std::size_t f = 0; f < values.size(); ++f) {
    c.frames.push_back(fmt::format("f{}", f));
    c.series[0].points.emplace_back(f, values[f]);
  }
  return c;
}

// Labels of the axis of values, from the lowest.
std::vector<std::string> ticksOf(const Chart& chart) {
  static const std::regex kTick(R"(text-anchor="end">(-?[0-9.]+)</text>)");
  const std::string svg = svgOf(chart);
  std::vector<std::string> ticks;
  for (std::sregex_iterator i(svg.begin(), svg.end(), kTick), end; i != end; ++i) ticks.push_back((*i)[1]);
  return ticks;
}

TEST(SvgChart, AConstantCurveHasRoundNumbersAroundIt) {
  EXPECT_THAT(ticksOf(chartOf({31.4, 31.4})), AllOf(Contains("30"), Contains("32"), SizeIs(4)));
  EXPECT_THAT(ticksOf(chartOf({400, 400, 400})), ElementsAre("380", "400", "420"));
  EXPECT_THAT(ticksOf(chartOf({4})), ElementsAre("3", "4", "5")) << "a count";
  EXPECT_THAT(ticksOf(chartOf({1, 1})), ElementsAre("0", "1", "2"));
  EXPECT_THAT(ticksOf(chartOf({0, 0})), ElementsAre("0", "1"));
}

TEST(SvgChart, NeighbouringTicksDiffer) {
  for (const std::vector<double>& values :
       {std::vector<double>{1234.1, 1236.2}, {4, 5}, {0.00012, 0.00034}, {-3, 8}, {29.98, 30.02}}) {
    const std::vector<std::string> ticks = ticksOf(chartOf(values));
    EXPECT_GE(ticks.size(), 2u);
    for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_NE(ticks[i - 1], ticks[i]);
  }
  EXPECT_THAT(ticksOf(chartOf({4, 5})), ElementsAre("4", "5")) << "there is nothing between two counts";
}

TEST(SvgChart, AValueWithoutNeighboursIsADot) {
  std::vector<double> values(100, std::nan(""));
  values[7] = 3;
  values[50] = values[51] = 4;
  const std::string svg = svgOf(chartOf(values));
  EXPECT_THAT(svg, AllOf(HasSubstr("<title>f7: 3</title>"), Not(HasSubstr("<title>f50"))));
  EXPECT_THAT(svgOf(chartOf({2.5})), HasSubstr("<title>f0: 2.5</title>"));
}

}  // namespace
}  // namespace beam::testing
