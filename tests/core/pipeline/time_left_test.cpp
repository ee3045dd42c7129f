// SPDX-License-Identifier: Apache-2.0
// Laws of the time that a run is said to take still.
#include "core/pipeline/time_left.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

StepKind kind(const std::string& step) { return {StepId(step), false, digestOf(std::string())}; }

ProgressReport share(double fraction) { return {fraction, "", 0, 0}; }

// Frames of three steps, of which the second takes as long as `truth` says; tells what was said at the start
// of every tenth of a step.
struct Said {
  double elapsed, likely, low, high;
};
std::vector<Said> said(TimeLeft& left, int frames, const std::map<std::string, double>& truth, double total) {
  for (int f = 0; f < frames; ++f) {
    for (const auto& [step, seconds] : truth) left.expect(kind(step), {});
  }
  std::vector<Said> all;
  double elapsed = 0;
  for (int f = 0; f < frames; ++f) {
    for (const auto& [step, seconds] : truth) {
      for (int tenth = 0; tenth < 10; ++tenth) {
        if (const auto s = left.left(kind(step), share(tenth * 0.1), seconds * tenth * 0.1))
          all.push_back({elapsed + seconds * tenth * 0.1, s->likely, s->low, s->high});
      }
      left.finish(kind(step), seconds);
      elapsed += seconds;
    }
  }
  EXPECT_NEAR(elapsed, total, 1e-9);
  return all;
}

TEST(TimeLeft, FallsFromTheFirstFigureOnWhenThisWasMeasuredBefore) {
  const std::map<std::string, double> truth = {{"a.seed", 5}, {"b.fit", 60}, {"c.bake", 20}};
  StepTimes before;
  for (const auto& [step, seconds] : truth) before.add(kind(step), {1}, 1.1 * seconds);
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
  left.expect(kind("a.fit"), {});
  EXPECT_FALSE(left.left(kind("a.fit"), {}, 0));
  EXPECT_FALSE(left.left(kind("a.other"), share(0.5), 10)) << "not expected";
  EXPECT_NEAR(left.left(kind("a.fit"), share(0.5), 10)->likely, 10, 1e-9);
}

TEST(TimeLeft, ForgetsWhatWillNotBeDone) {
  StepTimes before;
  before.add(kind("a.fit"), {1}, 10);
  TimeLeft left;
  left.know(before);
  for (int i = 0; i < 3; ++i) left.expect(kind("a.fit"), {});
  EXPECT_NEAR(left.left(kind("a.fit"), {}, 0)->likely, 30, 1e-9);
  left.drop(kind("a.fit"));
  EXPECT_NEAR(left.left(kind("a.fit"), {}, 0)->likely, 20, 1e-9);
}

TEST(Run, TellsTheTimeThatIsLeftWhenItWasMeasuredBefore) {
  FakeHouse house;
  Project project = house.newProject();
  RunRequest request;
  for (const StageInfo& info : fakeStages()) {
    for (const StepInfo& step : info.steps)
      request.times.add({StepId(info.id, step.id), false, settingsDigest({})}, {step.weight}, 100);
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

// The counter of a fit of a real capture, after times of the small sample: 2,500 iterations, 5.5 a second.
constexpr int kIterations = 2500;
constexpr double kRate = 5.5;

ProgressReport counted(int done) {
  return {static_cast<double>(done) / kIterations, "Fit", done, kIterations, "iterations"};
}

TimeLeft afterTheSample() {
  StepTimes before;
  before.add(kind("a.fit"), {45}, 5);
  before.add(kind("b.refine"), {45}, 8);
  TimeLeft left;
  left.know(before);
  left.expect(kind("a.fit"), {45});
  left.expect(kind("b.refine"), {45});
  return left;
}

TEST(TimeLeft, IsNeverLessThanTheCounterBesideItSays) {
  TimeLeft left = afterTheSample();
  double before_it = INFINITY;
  for (int done = 1; done <= kIterations; ++done) {
    const double seconds = 3 + done / kRate;
    const auto said = left.left(kind("a.fit"), counted(done), seconds);
    ASSERT_TRUE(said);
    if (left.rate() == 0) continue;
    EXPECT_NEAR(left.rate(), kRate, 1e-6) << "loading before the first does not count";
    const double own = (kIterations - done) / left.rate();
    ASSERT_GE(said->likely, own - 1e-9) << done;
    EXPECT_GE(said->high, own - 1e-9) << done;
    EXPECT_GE(said->low, 0.8 * own) << done;
    EXPECT_LE(said->likely, before_it + 1e-9) << done;
    before_it = said->likely;
  }
}

TEST(TimeLeft, OfLaterStepsFollowsWhatTheStepAtWorkTells) {
  TimeLeft left = afterTheSample();
  std::optional<Seconds> said;
  for (int done = 1; done <= 63; ++done) said = left.left(kind("a.fit"), counted(done), done / kRate);
  const double fit = (kIterations - 63) / kRate, refine = kIterations / kRate * 8 / 5;
  EXPECT_GT(said->likely, fit + 0.3 * refine);
  EXPECT_LT(said->likely, fit + 1.5 * refine);
}

TEST(TimeLeft, AShortStepThatIsSlowerSaysLittleOfLongOnes) {
  StepTimes before;
  before.add(kind("a.import"), {0.1}, 0.01);
  before.add(kind("b.fit"), {45}, 1000);
  TimeLeft left;
  left.know(before);
  left.expect(kind("a.import"), {0.1});
  left.expect(kind("b.fit"), {45});
  left.finish(kind("a.import"), 1);
  EXPECT_LT(left.left(kind("b.fit"), {}, 0)->likely, 1500);
}

TEST(TimeLeft, KeepsApartThePartsOfAStep) {
  StepPace pace;
  for (int i = 0; i <= 10; ++i) pace.feed(i, {0.05 * i, "held-out", i, 10});
  EXPECT_NEAR(pace.rate(), 1, 1e-9);
  pace.feed(11, {0.5, "training", 1, 40});
  EXPECT_EQ(pace.rate(), 0) << "nothing is known of this part yet";
  for (int i = 2; i <= 10; ++i) pace.feed(11 + 0.25 * i, {0.5 + i / 80.0, "training", i, 40});
  EXPECT_NEAR(pace.rate(), 4, 0.5);
  EXPECT_NEAR(pace.countedLeft(), 7.5, 1);
}

TEST(Run, NeverTellsLessThanItsCounterSays) {
  FakeHouse house;
  house.frame_names = {"000"};
  Project project = house.newProject();
  house.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step != "surface.fit"_step) return;
    c.progress.expect(60, "iterations");
    for (int i = 0; i < 60; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
      c.progress.step();
    }
  };
  RunRequest request;
  for (const StageInfo& info : fakeStages()) {
    for (const StepInfo& step : info.steps)
      request.times.add({StepId(info.id, step.id), false, settingsDigest({})}, {step.weight}, 0.01);
  }
  int told = 0;
  for (const JobEvent& event : house.run(project, request)) {
    const auto* p = std::get_if<StepProgress>(&event);
    if (p == nullptr || p->rate <= 0) continue;
    ++told;
    EXPECT_GE(p->seconds_left, p->countedLeft() - 1e-9) << p->report.done;
    EXPECT_GE(p->seconds_left_high, p->countedLeft() - 1e-9) << p->report.done;
    EXPECT_EQ(p->report.unit, "iterations");
  }
  EXPECT_GT(told, 5);
}

}  // namespace
}  // namespace beam::testing
