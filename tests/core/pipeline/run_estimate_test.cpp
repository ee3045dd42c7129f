// SPDX-License-Identifier: Apache-2.0
// What is said of a run before it starts, and of the time that it still takes.
#include "core/pipeline/run_estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

StepKind kind(const std::string& step, bool later = false, const std::string& settings = {}) {
  return {step, later, digestOf(settings)};
}

TEST(RunEstimate, OfAFreshProjectIsEverythingAndUnmeasured) {
  FakeHouse house;
  const RunEstimate e = estimateRun(house.newProject(), {}, {});
  EXPECT_EQ(e.frames, 3);
  EXPECT_EQ(e.frames_total, 3);
  EXPECT_EQ(e.steps_total, 14);
  EXPECT_EQ(e.steps_missing, 14);
  EXPECT_FALSE(e.measured);
  EXPECT_EQ(e.seconds_high, 0);
}

TEST(RunEstimate, OfADoneRunIsNothing) {
  FakeHouse house;
  const Project project = house.newProject();
  house.finish(project);
  const RunEstimate e = estimateRun(project, {}, readStepTimes(project));
  EXPECT_EQ(e.steps_missing, 0);
  EXPECT_EQ(e.steps_total, 14);
  EXPECT_EQ(e.frames, 0);
  EXPECT_EQ(e.seconds_high, 0);
  EXPECT_TRUE(e.measured);
}

TEST(RunEstimate, SaysAsManyStepsAsTheRunComputes) {
  for (const auto& stages : {fakeStages(), fakeStagesWithTakes()}) {
    FakeHouse house(stages);
    Project project = house.newProject();
    RunRequest first_two;
    first_two.frames = {FrameIndex{0}, FrameIndex{1}};
    house.finish(project, first_two);
    project.readTakesAgain();
    project.set("materials.iterations", 11);
    for (const RunRequest& request :
         {RunRequest{}, RunRequest{.frames = {FrameIndex{1}}}, RunRequest{.until = "surface"},
          RunRequest{.frames = {FrameIndex{1}, FrameIndex{2}}, .overlap = 1}}) {
      const RunEstimate e = estimateRun(project, request, {});
      const JobFinished finished = house.finish(project, request);
      EXPECT_EQ(e.steps_missing, finished.computed);
      EXPECT_EQ(e.steps_total, finished.computed + finished.reused);
      project.readTakesAgain();
    }
  }
}

TEST(RunEstimate, ChangesNoTakesAndNoFile) {
  FakeHouse house(fakeStagesWithTakes());
  const Project project = house.newProject();
  const auto before = everythingIn(house.root());
  const RunEstimate e = estimateRun(project, {}, {});
  EXPECT_GT(e.steps_missing, 0);
  EXPECT_EQ(everythingIn(house.root()), before);
  EXPECT_TRUE(project.takes().empty());
}

TEST(RunEstimate, AddsUpWhatWasMeasured) {
  FakeHouse house;
  const Project project = house.newProject();
  StepTimes times;
  for (const char* step : {"capture.import", "light.import", "surface.seed", "surface.fit", "surface.refine",
                           "materials.bake"}) {
    times.add(kindOf(project.ingredients(step, FrameIndex{0})), 1, 10);
  }
  const RunEstimate e = estimateRun(project, {}, times);
  EXPECT_TRUE(e.measured);
  EXPECT_LT(e.seconds_low, 14 * 10);
  EXPECT_GT(e.seconds_high, 14 * 10);
  EXPECT_LT(e.seconds_high, 1.5 * e.seconds_low);
}

TEST(StepTimes, OfTheSameSettingsComeBeforeThoseOfOthersAndTheseBeforeWeights) {
  StepTimes times;
  times.add(kind("a.fit", false, "draft"), 2, 10);
  times.add(kind("a.fit", false, "paper"), 2, 1000);
  times.add(kind("a.fit", true, "draft"), 2, 40);
  EXPECT_EQ(times.guess(kind("a.fit", false, "draft"), 2)->likely, 10);
  EXPECT_EQ(times.guess(kind("a.fit", true, "draft"), 2)->likely, 40);
  const auto other = times.guess(kind("a.fit", true, "paper"), 2);
  EXPECT_EQ(other->likely, 40) << "later frames, draft";
  EXPECT_LT(other->low, 25);
  EXPECT_GT(other->high, 75);
  StepTimes one;
  one.add(kind("a.fit"), 2, 10);
  const auto never = one.guess(kind("a.bake"), 6);
  EXPECT_EQ(never->likely, 30) << "by weight";
  EXPECT_LT(never->low, 15);
  EXPECT_FALSE(StepTimes().guess(kind("a.fit"), 2));
}

TEST(StepTimes, AreReadFromRecordsAndKeptAsText) {
  FakeHouse house(fakeStagesWithTakes());
  const Project project = house.newProject();
  house.finish(project);
  const StepTimes times = readStepTimes(project);
  EXPECT_TRUE(times.ofKind({"surface.refine", false, settingsDigest({})}));
  EXPECT_TRUE(times.ofKind({"surface.refine", true, settingsDigest({})}));
  EXPECT_FALSE(times.ofKind({"surface.fit", true, settingsDigest({})}));
  EXPECT_EQ(toJson(parseStepTimes(toJson(times))), toJson(times));
  for (const char* broken : {"", "{}}", "[1]", "[{\"step\": 1}]"}) {
    EXPECT_THROW(parseStepTimes(broken), Error) << broken;
  }
}

// Frames of three steps, of which the second takes as long as `truth` says; tells what was said at the start
// of every tenth of a step.
struct Said {
  double elapsed, likely, low, high;
};
std::vector<Said> said(TimeLeft& left, int frames, const std::map<std::string, double>& truth, double total) {
  for (int f = 0; f < frames; ++f) {
    for (const auto& [step, seconds] : truth) left.expect(kind(step), 1);
  }
  std::vector<Said> all;
  double elapsed = 0;
  for (int f = 0; f < frames; ++f) {
    for (const auto& [step, seconds] : truth) {
      for (int tenth = 0; tenth < 10; ++tenth) {
        if (const auto s = left.left(kind(step), tenth * 0.1, seconds * tenth * 0.1))
          all.push_back({elapsed + seconds * tenth * 0.1, s->likely, s->low, s->high});
      }
      left.finish(kind(step), 1, seconds);
      elapsed += seconds;
    }
  }
  EXPECT_NEAR(elapsed, total, 1e-9);
  return all;
}

TEST(TimeLeft, FallsFromTheFirstFigureOnWhenThisWasMeasuredBefore) {
  const std::map<std::string, double> truth = {{"a.seed", 5}, {"b.fit", 60}, {"c.bake", 20}};
  StepTimes before;
  for (const auto& [step, seconds] : truth) before.add(kind(step), 1, 1.1 * seconds);
  TimeLeft left;
  left.know(before);
  const std::vector<Said> all = said(left, 4, truth, 340);
  ASSERT_EQ(all.size(), 120u) << "from the start";
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double before_it = i > 0 ? all[i - 1].likely : all[i].likely;
    EXPECT_LE(all[i].likely, before_it + 1e-9) << i;
    EXPECT_NEAR(all[i].likely, 340 - all[i].elapsed, 0.15 * 340) << i;
    EXPECT_LE(all[i].low, all[i].likely);
    EXPECT_GE(all[i].high, all[i].likely);
  }
}

TEST(TimeLeft, OfARunThatNothingWasMeasuredForLearnsFromItsFirstFrame) {
  const std::map<std::string, double> truth = {{"a.seed", 5}, {"b.fit", 60}, {"c.bake", 20}};
  TimeLeft left;
  const std::vector<Said> all = said(left, 4, truth, 340);
  ASSERT_FALSE(all.empty());
  for (const Said& s : all) {
    if (s.elapsed < 85) continue;
    EXPECT_NEAR(s.likely, 340 - s.elapsed, 0.26 * (340 - s.elapsed) + 1) << s.elapsed;
  }
}

TEST(TimeLeft, KnowsNothingBeforeTheFirstMeasurement) {
  TimeLeft left;
  left.expect(kind("a.fit"), 1);
  EXPECT_FALSE(left.left(kind("a.fit"), 0, 0));
  EXPECT_FALSE(left.left(kind("a.other"), 0.5, 10)) << "not expected";
  EXPECT_NEAR(left.left(kind("a.fit"), 0.5, 10)->likely, 10, 1e-9);
}

TEST(TimeLeft, ForgetsWhatWillNotBeDone) {
  StepTimes before;
  before.add(kind("a.fit"), 1, 10);
  TimeLeft left;
  left.know(before);
  for (int i = 0; i < 3; ++i) left.expect(kind("a.fit"), 1);
  EXPECT_NEAR(left.left(kind("a.fit"), 0, 0)->likely, 30, 1e-9);
  left.drop(kind("a.fit"));
  EXPECT_NEAR(left.left(kind("a.fit"), 0, 0)->likely, 20, 1e-9);
}

TEST(Run, TellsTheTimeThatIsLeftWhenItWasMeasuredBefore) {
  FakeHouse house;
  Project project = house.newProject();
  RunRequest request;
  for (const StageInfo& info : fakeStages()) {
    for (const StepInfo& step : info.steps)
      request.times.add({info.id + "." + step.id, false, settingsDigest({})}, step.weight, 100);
  }
  double first = -1, low = 0, high = 0;
  for (const JobEvent& event : house.run(project, request)) {
    const auto* p = std::get_if<StepProgress>(&event);
    if (p == nullptr || first >= 0) continue;
    first = p->seconds_left, low = p->seconds_left_low, high = p->seconds_left_high;
  }
  EXPECT_NEAR(first, 1400, 1) << "fourteen steps";
  EXPECT_LT(low, first);
  EXPECT_GT(high, first);
}

}  // namespace
}  // namespace beam::testing
