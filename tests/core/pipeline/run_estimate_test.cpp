// SPDX-License-Identifier: Apache-2.0
// What is said of a run before it starts.
#include "core/pipeline/run_estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;

StepKind kind(const std::string& step, bool later = false, const std::string& settings = {}) {
  return {StepId(step), later, digestOf(settings)};
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
  EXPECT_THAT(toText(e),
              HasSubstr("14 of 14 results to compute, for 3 of 3 frames; the time is not known yet"));
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
  for (const StepId& step : {"capture.import"_step, "light.import"_step, "surface.seed"_step,
                             "surface.fit"_step, "surface.refine"_step, "materials.bake"_step}) {
    times.add(kindOf(project.ingredients(step, FrameIndex{0})), {1}, 10);
  }
  const RunEstimate e = estimateRun(project, {}, times);
  EXPECT_TRUE(e.measured);
  EXPECT_LT(e.seconds_low, 14 * 10);
  EXPECT_GT(e.seconds_high, 14 * 10);
  EXPECT_LT(e.seconds_high, 1.5 * e.seconds_low);
}

// Fake stages whose work is that of real ones.
std::vector<StageInfo> stagesWithWork() {
  std::vector<StageInfo> stages = fakeStages();
  for (StageInfo& stage : stages) {
    for (StepInfo& step : stage.steps) {
      step.work = {.photographs = true, .pixels = true};
      if (step.id == "fit") step.work.times = "surface.iterations";
    }
  }
  return stages;
}

TEST(RunEstimate, OfTenTimesTheWorkIsAboutTenTimesAsLong) {
  FakeHouse house(stagesWithWork());
  const Project small = house.newProject("small.beam");
  house.hooks.at_step = [](const StepId&, StepContext&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  };
  house.finish(small);
  const StepTimes times = readStepTimes(small);
  house.hooks.at_step = {};
  const auto middle = [&](const Project& project) {
    const RunEstimate e = estimateRun(project, {}, times);
    EXPECT_TRUE(e.measured);
    return std::sqrt(e.seconds_low * e.seconds_high);
  };
  Project other = house.newProject("other.beam");
  other.set("surface.solver", std::string("fancy"));
  const double as_large = middle(other);
  const auto open = house.setup->open_capture;
  house.setup->open_capture = [open](const std::filesystem::path& folder, const ImportOptions& options) {
    ImportedCapture imported = open(folder, options);
    for (View& view : imported.set.views) view.camera.width *= 10;
    return imported;
  };
  const double ten_times = middle(house.newProject("large.beam"));
  EXPECT_NEAR(ten_times / as_large, 10, 3);
  Project longer = house.newProject("longer.beam");
  longer.set("surface.iterations", 100);
  EXPECT_GT(middle(longer), 2 * ten_times) << "a fifth of the time was the fit";
}

TEST(StepTimes, OfTheSameSettingsComeBeforeThoseOfOthersAndTheseBeforeWeights) {
  StepTimes times;
  times.add(kind("a.fit", false, "draft"), {2}, 10);
  times.add(kind("a.fit", false, "paper"), {2}, 1000);
  times.add(kind("a.fit", true, "draft"), {2}, 40);
  EXPECT_EQ(times.guess(kind("a.fit", false, "draft"), {2})->likely, 10);
  EXPECT_EQ(times.guess(kind("a.fit", true, "draft"), {2})->likely, 40);
  const auto other = times.guess(kind("a.fit", true, "paper"), {2});
  EXPECT_EQ(other->likely, 40) << "later frames, draft";
  EXPECT_LT(other->low, 25);
  EXPECT_GT(other->high, 75);
  StepTimes one;
  one.add(kind("a.fit"), {2}, 10);
  const auto never = one.guess(kind("a.bake"), {6});
  EXPECT_EQ(never->likely, 30) << "by weight";
  EXPECT_LT(never->low, 15);
  EXPECT_FALSE(StepTimes().guess(kind("a.fit"), {2}));
}

TEST(StepTimes, GrowWithTheWorkAndSoDoesTheirDoubt) {
  StepTimes times;
  times.add(kind("a.fit", false, "draft"), {.weight = 1, .work = 100}, 10);
  const auto same = times.guess(kind("a.fit", false, "draft"), {.weight = 1, .work = 100});
  EXPECT_NEAR(same->likely, 10, 1e-9);
  EXPECT_LT(same->high, 1.5 * same->low);
  for (const char* settings : {"draft", "standard"}) {
    const auto larger = times.guess(kind("a.fit", false, settings), {.weight = 1, .work = 1000});
    EXPECT_NEAR(larger->likely, 100, 1e-9) << settings;
    EXPECT_GT(larger->high, 4 * larger->low) << "ten times the work: a guess";
  }
  times.add(kind("a.fit", false, "standard"), {.weight = 1, .work = 900}, 200);
  EXPECT_NEAR(times.guess(kind("a.fit", false, "draft"), {.weight = 1, .work = 900})->likely, 200, 1e-9)
      << "as much work with other settings tells more than a ninth of it";
  times.add(kind("a.fit", false, "draft"), {.weight = 1, .work = 1000}, 300);
  EXPECT_NEAR(times.guess(kind("a.fit", false, "draft"), {.weight = 1, .work = 1000})->likely, 300, 1e-9);
}

TEST(StepTimes, OfOneThatIsMuchLighterSayNothing) {
  StepTimes times;
  times.add(kind("a.import"), {.weight = 0.1}, 0.01);
  EXPECT_FALSE(times.guess(kind("a.fit"), {.weight = 45}));
  EXPECT_TRUE(times.guess(kind("a.screen"), {.weight = 0.5}));
}

TEST(StepTimes, OfAnEarlierVersionAreReadAndDoubted) {
  const std::string settings = digestOf(std::string("draft")).hex();
  const StepTimes times = parseStepTimes(R"([{"step": "a.fit", "later": false, "settings": ")" + settings +
                                         R"(", "weight": 45.0, "seconds": [10.0, 10.0]}])");
  const auto said = times.guess(kind("a.fit", false, "draft"), {.weight = 45, .work = 1e6});
  ASSERT_TRUE(said);
  EXPECT_NEAR(said->likely, 10, 1e-9);
  EXPECT_LT(said->low, 3);
  EXPECT_GT(said->high, 35);
}

TEST(StepTimes, AreReadFromRecordsAndKeptAsText) {
  FakeHouse house(fakeStagesWithTakes());
  const Project project = house.newProject();
  house.finish(project);
  const StepTimes times = readStepTimes(project);
  EXPECT_TRUE(times.knows({"surface.refine"_step, false, settingsDigest({})}));
  EXPECT_TRUE(times.knows({"surface.refine"_step, true, settingsDigest({})}));
  EXPECT_FALSE(times.knows({"surface.fit"_step, true, settingsDigest({})}));
  EXPECT_EQ(toJson(parseStepTimes(toJson(times))), toJson(times));
  for (const char* broken : {"", "{}}", "[1]", "[{\"step\": 1}]"}) {
    EXPECT_THROW(parseStepTimes(broken), Error) << broken;
  }
}

}  // namespace
}  // namespace beam::testing
