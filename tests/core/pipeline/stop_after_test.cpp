// SPDX-License-Identifier: Apache-2.0
// Runs that are asked to stop after the step or frame at work, and runs that wait for another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

std::vector<JobEvent> eventsOf(Runner& runner) {
  std::vector<JobEvent> events;
  while (events.empty() || !std::holds_alternative<JobFinished>(events.back())) {
    if (auto event = runner.waitPop(100ms)) events.push_back(std::move(*event));
  }
  return events;
}

// A run that is asked to stop when it is in `step` of frame 1.
JobFinished stoppedIn(FakeHouse& house, Runner& runner, const StepId& step, StopAfter what) {
  house.hooks.at_step = [&, step, what](const StepId& id, StepContext& c) {
    if (id == step && c.frame.value == 1) runner.requestStopAfter(what);
  };
  runner.start(house.newProject(), {}, std::make_shared<FakeDevice>());
  const JobFinished finished = std::get<JobFinished>(eventsOf(runner).back());
  house.hooks.at_step = nullptr;
  return finished;
}

std::map<std::string, std::string> productsOfAnUndisturbedRun() {
  FakeHouse house;
  house.finish(house.newProject());
  return productsOf(house.root() / "p.beam");
}

TEST(StopAfter, AStepKeepsItAndStartsNoOther) {
  FakeHouse house;
  Runner runner;
  const JobFinished finished = stoppedIn(house, runner, "surface.fit"_step, StopAfter::Step);
  EXPECT_EQ(finished.outcome, JobOutcome::Cancelled);
  EXPECT_TRUE(finished.at_rest);
  ASSERT_FALSE(finished.notes.empty());
  EXPECT_THAT(finished.notes.back(), HasSubstr("\"Fit\" of frame 001"));
  EXPECT_FALSE(runner.running());
  EXPECT_EQ(house.open().state("surface.fit"_step, FrameIndex{1}), StepState::Done);
  EXPECT_EQ(house.open().state("surface.refine"_step, FrameIndex{1}), StepState::Pending);
}

TEST(StopAfter, AFrameFinishesEveryStepOfItAndStartsNoOther) {
  FakeHouse house;
  Runner runner;
  const JobFinished finished = stoppedIn(house, runner, "surface.seed"_step, StopAfter::Frame);
  EXPECT_TRUE(finished.at_rest);
  EXPECT_EQ(house.open().stageState("materials", FrameIndex{1}), StepState::Done);
  EXPECT_EQ(house.open().state("surface.seed"_step, FrameIndex{2}), StepState::Pending);
}

TEST(StopAfter, AStoppedRunGoesOnToTheSameBytes) {
  const auto whole = productsOfAnUndisturbedRun();
  for (const StopAfter what : {StopAfter::Step, StopAfter::Frame}) {
    FakeHouse house;
    {
      Runner runner;
      stoppedIn(house, runner, "surface.refine"_step, what);
    }
    house.hooks.computed.clear();
    EXPECT_EQ(house.finish(house.open()).outcome, JobOutcome::Done);
    EXPECT_EQ(house.hooks.computed["materials.bake"_step], what == StopAfter::Step ? 2 : 1);
    EXPECT_EQ(productsOf(house.root() / "p.beam"), whole);
  }
}

TEST(StopAfter, TheLastStepOfARunIsARunThatIsDone) {
  FakeHouse house;
  Runner runner;
  house.hooks.at_step = [&](const StepId& id, StepContext& c) {
    if (id == "materials.bake"_step && c.frame.value == 2) runner.requestStopAfter(StopAfter::Step);
  };
  runner.start(house.newProject(), {}, std::make_shared<FakeDevice>());
  const JobFinished finished = std::get<JobFinished>(eventsOf(runner).back());
  EXPECT_EQ(finished.outcome, JobOutcome::Done);
  EXPECT_FALSE(finished.at_rest);
}

TEST(StopAfter, IsForgottenByTheNextRun) {
  FakeHouse house;
  Runner runner;
  stoppedIn(house, runner, "surface.fit"_step, StopAfter::Step);
  runner.start(house.open(), {}, std::make_shared<FakeDevice>());
  EXPECT_EQ(std::get<JobFinished>(eventsOf(runner).back()).outcome, JobOutcome::Done);
}

TEST(StopAfter, StoppingNowIsStillPossible) {
  FakeHouse house;
  Runner runner;
  std::atomic<bool> inside{false};
  house.hooks.at_step = [&](const StepId& id, StepContext& c) {
    if (id != "surface.fit"_step) return;
    inside = true;
    for (;;) {
      c.progress.check();
      std::this_thread::sleep_for(1ms);
    }
  };
  runner.start(house.newProject(), {}, std::make_shared<FakeDevice>());
  while (!inside) std::this_thread::sleep_for(1ms);
  runner.requestStopAfter(StopAfter::Frame);
  runner.requestStop();
  const JobFinished finished = std::get<JobFinished>(eventsOf(runner).back());
  EXPECT_EQ(finished.outcome, JobOutcome::Cancelled);
  EXPECT_FALSE(finished.at_rest);
  EXPECT_EQ(house.open().state("surface.fit"_step, {}), StepState::Pending);
}

// Waits until `runner` tells something of kind E.
template <class E>
E next(Runner& runner) {
  for (;;) {
    const auto event = runner.waitPop(100ms);
    if (!event) continue;
    if (const E* found = std::get_if<E>(&*event)) return *found;
    if (std::holds_alternative<JobFinished>(*event)) throw Error(Error::Kind::Bug, "the run ended");
  }
}

TEST(WaitingRun, SaysOnceForWhatAndWhom) {
  FakeHouse house;
  const Project project = house.newProject();
  auto lease = project.store().tryLease(project.key("surface.fit"_step, FrameIndex{0}));
  ASSERT_TRUE(lease);
  Runner runner;
  runner.start(house.open(), {{FrameIndex{0}}, "", ""}, std::make_shared<FakeDevice>());
  const JobWaiting waiting = next<JobWaiting>(runner);
  EXPECT_EQ(waiting.ref.step, "surface.fit"_step);
  EXPECT_EQ(waiting.ref.frame_name, "000");
  EXPECT_EQ(waiting.holder, "process " + std::to_string(::getpid()) + " on this machine");
  std::this_thread::sleep_for(350ms);  // more than two looks
  lease.reset();
  int told = 0;
  const std::vector<JobEvent> rest = eventsOf(runner);
  for (const JobEvent& event : rest) told += std::holds_alternative<JobWaiting>(event);
  EXPECT_EQ(told, 0);
  EXPECT_EQ(std::get<JobFinished>(rest.back()).outcome, JobOutcome::Done);
}

TEST(WaitingRun, SaysNothingWhileItHasOtherFramesToDo) {
  FakeHouse house;
  const Project project = house.newProject();
  auto lease = project.store().tryLease(project.key("surface.fit"_step, FrameIndex{0}));
  ASSERT_TRUE(lease);
  bool told = false;
  Runner runner;
  runner.start(house.open(), {}, std::make_shared<FakeDevice>());
  for (;;) {
    const auto event = runner.waitPop(100ms);
    if (!event) continue;
    if (std::holds_alternative<JobFinished>(*event)) break;
    if (!std::holds_alternative<JobWaiting>(*event)) continue;
    told = true;
    EXPECT_EQ(house.open().stageState("materials", FrameIndex{2}), StepState::Done) << "the others first";
    lease.reset();
  }
  EXPECT_TRUE(told);
}

TEST(WaitingRun, RestsAtOnceWhenItIsAskedToStopAfterSomething) {
  FakeHouse house;
  const Project project = house.newProject();
  const auto lease = project.store().tryLease(project.key("surface.fit"_step, FrameIndex{0}));
  Runner runner;
  runner.start(house.open(), {{FrameIndex{0}}, "", ""}, std::make_shared<FakeDevice>());
  next<JobWaiting>(runner);
  runner.requestStopAfter(StopAfter::Frame);
  const JobFinished finished = std::get<JobFinished>(eventsOf(runner).back());
  EXPECT_TRUE(finished.at_rest);
}

TEST(WaitingRun, NamesTheMachineOfAProcessElsewhere) {
  FakeHouse house;
  const Project project = house.newProject();
  const Digest key = project.key("surface.fit"_step, FrameIndex{0});
  EXPECT_EQ(project.store().leaseHolder(key), "another process");
  std::filesystem::create_directories(project.folder() / "leases");
  std::ofstream(project.folder() / "leases" / key.hex()) << "host studio-7.example, process 12\n";
  EXPECT_EQ(project.store().leaseHolder(key), "process 12 on host studio-7.example");
}

}  // namespace
}  // namespace beam::testing
