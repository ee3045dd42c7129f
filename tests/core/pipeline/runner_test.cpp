// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <atomic>
#include <new>
#include <thread>

#include "core/base/log.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

constexpr int kSteps = 2 + 3 * 4;  // two for the project, four for each of three frames

TEST(Run, ComputesEveryStepOnce) {
  FakeHouse house;
  const JobFinished finished = house.finish(house.newProject());
  EXPECT_EQ(finished.outcome, JobOutcome::Done);
  EXPECT_EQ(finished.computed, kSteps);
  EXPECT_EQ(finished.reused, 0);
}

TEST(Run, ASecondRunComputesNothingAndSaysSo) {
  FakeHouse house;
  house.finish(house.newProject());
  house.hooks.computed.clear();
  const auto before = everythingIn(house.root() / "p.beam" / "results");
  const std::vector<JobEvent> events = house.run(house.open());
  EXPECT_TRUE(house.hooks.computed.empty());
  int reused = 0;
  for (const JobEvent& event : events) {
    if (const auto* step = std::get_if<StepFinished>(&event)) reused += step->reused;
  }
  EXPECT_EQ(reused, kSteps);
  EXPECT_EQ(std::get<JobFinished>(events.back()).computed, 0);
  EXPECT_EQ(everythingIn(house.root() / "p.beam" / "results"), before);
}

TEST(Run, AChangedGroupFieldComputesOnlyFromThereOn) {
  FakeHouse house;
  Project p = house.newProject();
  house.finish(p);
  house.hooks.computed.clear();
  p.set("surface.refine.normal_weight", 0.5);
  house.finish(p);
  EXPECT_EQ(house.hooks.computed,
            (std::map<StepId, int>{{"materials.bake"_step, 3}, {"surface.refine"_step, 3}}));
}

TEST(Run, TakesOnlyTheFramesAndStagesItIsAskedFor) {
  FakeHouse house;
  house.finish(house.newProject(), {{FrameIndex{1}}, "", "surface"});
  EXPECT_EQ(house.hooks.computed.count("materials.bake"_step), 0u);
  EXPECT_EQ(house.hooks.computed["surface.refine"_step], 1);
  house.hooks.computed.clear();
  house.finish(house.newProject("q.beam"), {{FrameIndex{2}}, "surface", ""});
  EXPECT_EQ(house.hooks.computed, (std::map<StepId, int>{{"capture.import"_step, 1},
                                                         {"surface.fit"_step, 1},
                                                         {"surface.refine"_step, 1},
                                                         {"surface.seed"_step, 1}}));
  EXPECT_EQ(house.finish(house.open(), {{}, "", "nonsense"}).kind, Error::Kind::Usage);
}

TEST(Run, WithANamedPanoramaThatIsGoneItDoesNotStart) {
  FakeHouse house;
  Project project = house.newProject();
  house.finish(project);
  std::filesystem::copy_file(house.root() / "light.hdr", house.root() / "other.hdr");
  project.setEnvironment(house.root() / "other.hdr");
  project.save();
  std::filesystem::remove(house.root() / "other.hdr");
  EXPECT_EQ(project.stageState("surface", FrameIndex{0}), StepState::Done);
  EXPECT_EQ(project.stageState("materials", FrameIndex{0}), StepState::Blocked);
  EXPECT_THAT(project.blockedReason("materials"), HasSubstr("other.hdr"));
  const JobFinished finished = house.finish(project);
  EXPECT_EQ(finished.outcome, JobOutcome::Failed);
  EXPECT_THAT(finished.message, HasSubstr("panorama"));
}

TEST(Run, WithoutAPanoramaItStopsAfterSurfaceAndSaysWhatIsNeeded) {
  FakeHouse house;
  house.has_panorama = false;
  const JobFinished finished = house.finish(house.newProject());
  EXPECT_EQ(finished.outcome, JobOutcome::Done);
  EXPECT_EQ(house.hooks.computed["surface.refine"_step], 3);
  EXPECT_EQ(house.hooks.computed.count("materials.bake"_step), 0u);
  ASSERT_FALSE(finished.notes.empty());
  EXPECT_THAT(finished.notes.back(), HasSubstr("panorama"));
  EXPECT_EQ(house.open().state("materials.bake"_step, {}), StepState::Blocked);
  EXPECT_EQ(house.finish(house.open(), {{}, "materials", ""}).kind, Error::Kind::Data);
}

TEST(Run, OneBadFrameDoesNotStopTheOthers) {
  FakeHouse house;
  house.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step == "surface.fit"_step && c.frame.value == 1)
      throw Error(Error::Kind::Data, "picture \"x.png\" is torn");
  };
  const JobFinished finished = house.finish(house.newProject());
  EXPECT_EQ(finished.outcome, JobOutcome::DoneWithFailures);
  ASSERT_EQ(finished.failed.size(), 1u);
  EXPECT_EQ(finished.failed[0].ref.frame_name, "001");
  EXPECT_EQ(house.hooks.computed["materials.bake"_step], 2);
  const Project p = house.open();
  EXPECT_EQ(p.state("surface.fit"_step, FrameIndex{1}), StepState::Failed);
  EXPECT_THAT(p.failureOf("surface.fit"_step, FrameIndex{1}), HasSubstr("x.png"));
  EXPECT_EQ(p.state("surface.refine"_step, FrameIndex{1}), StepState::Pending);
  EXPECT_EQ(p.stageState("materials", FrameIndex{2}), StepState::Done);

  house.hooks.at_step = nullptr;  // mended
  EXPECT_EQ(house.finish(house.open()).outcome, JobOutcome::Done);
  EXPECT_EQ(house.open().state("surface.fit"_step, FrameIndex{1}), StepState::Done);
  EXPECT_TRUE(house.open().failureOf("surface.fit"_step, FrameIndex{1}).empty());
}

TEST(Run, AReadErrorThatPassesEndsItAndPublishesNothingOfTheFrame) {
  FakeHouse house;
  const Project p = house.newProject();
  house.frames->fault = [] { throw Error(Error::Kind::Storage, "the disk does not answer"); };
  const JobFinished finished = house.finish(house.open());
  EXPECT_EQ(finished.outcome, JobOutcome::Failed);
  EXPECT_EQ(finished.kind, Error::Kind::Storage);
  EXPECT_EQ(house.hooks.computed["surface.seed"_step], 0);
  house.frames->fault = nullptr;
  EXPECT_EQ(house.finish(house.open()).outcome, JobOutcome::Done);
  EXPECT_EQ(p.state("surface.seed"_step, FrameIndex{1}), StepState::Done);
}

TEST(Run, LackOfMemoryEndsItWithItsOwnKind) {
  FakeHouse house;
  house.hooks.at_step = [](const StepId& step, StepContext&) {
    if (step == "surface.fit"_step) throw std::bad_alloc();
  };
  const JobFinished finished = house.finish(house.newProject());
  EXPECT_EQ(finished.outcome, JobOutcome::Failed);
  EXPECT_EQ(finished.kind, Error::Kind::OutOfMemory);
  EXPECT_THAT(finished.message, HasSubstr("out of memory in surface.fit, frame 000"));
  EXPECT_THAT(finished.message, HasSubstr("are free"));
  EXPECT_THAT(finished.message, HasSubstr("lower surface.iterations (now 10)"));

  house.hooks.at_step = [](const StepId& step, StepContext&) {
    if (step == "surface.seed"_step) throw Error(Error::Kind::OutOfMemory, "a library says so");
  };
  const JobFinished other = house.finish(house.newProject("q.beam"));
  EXPECT_EQ(other.kind, Error::Kind::OutOfMemory);
  EXPECT_THAT(other.message, HasSubstr("surface.seed"));
  EXPECT_THAT(other.message, ::testing::Not(HasSubstr("surface.iterations"))) << "not of that step";
}

TEST(Run, AFaultOfOurOwnSaysWhereItWasAndWhatToDo) {
  FakeHouse house;
  house.hooks.at_step = [](const StepId& step, StepContext&) {
    if (step == "surface.fit"_step) throw std::out_of_range("vector::_M_range_check");
  };
  const JobFinished finished = house.finish(house.newProject());
  EXPECT_EQ(finished.kind, Error::Kind::Bug);
  for (const char* part : {"surface.fit, frame 000", "vector::_M_range_check", "report it", "logs"})
    EXPECT_THAT(finished.message, HasSubstr(part));
}

TEST(Run, ACancelEndsItSoonAndLeavesOnlyWholeResults) {
  FakeHouse house;
  std::atomic<bool> inside{false};
  house.hooks.at_step = [&](const StepId& step, StepContext& c) {
    if (step != "surface.fit"_step) return;
    std::ofstream(c.folder / "half.txt") << "half";
    inside = true;
    for (;;) {
      c.progress.check();
      std::this_thread::sleep_for(1ms);
    }
  };
  Runner runner;
  runner.start(house.newProject(), {}, std::make_shared<FakeDevice>());
  while (!inside) std::this_thread::sleep_for(1ms);
  runner.requestStop();
  std::optional<JobFinished> finished;
  while (!finished) {
    if (auto event = runner.waitPop(100ms)) {
      if (auto* end = std::get_if<JobFinished>(&*event)) finished = *end;
    }
  }
  EXPECT_EQ(finished->outcome, JobOutcome::Cancelled);
  EXPECT_FALSE(runner.running());
  for (const auto& entry : std::filesystem::directory_iterator(house.root() / "p.beam" / "results")) {
    EXPECT_NE(entry.path().filename().string().front(), '.');
  }
  EXPECT_EQ(house.open().state("surface.seed"_step, {}), StepState::Done);
  EXPECT_EQ(house.open().state("surface.fit"_step, {}), StepState::Pending);
}

TEST(Run, ADamagedResultIsNamedAndComputedAgain) {
  FakeHouse house;
  house.finish(house.newProject());
  const auto whole = productsOf(house.root() / "p.beam");
  const auto folder = house.open().result("surface.fit"_step, FrameIndex{1});
  ASSERT_TRUE(folder);
  std::ofstream(*folder / "data.txt", std::ios::in | std::ios::out) << "?";
  house.hooks.computed.clear();
  std::string warning;
  for (const JobEvent& event : house.run(house.open())) {
    if (const auto* w = std::get_if<JobWarning>(&event)) warning = w->text;
  }
  EXPECT_THAT(warning, HasSubstr("data.txt"));
  EXPECT_EQ(house.hooks.computed, (std::map<StepId, int>{{"surface.fit"_step, 1}}));
  EXPECT_EQ(productsOf(house.root() / "p.beam"), whole);
}

TEST(Run, AResultMadeWhileItsInputChangedIsNotKept) {
  FakeHouse house;
  house.hooks.at_step = [&](const StepId& step, StepContext& c) {
    if (step == "surface.fit"_step && c.frame.value == 0) house.frames->changed[{0, 0}] = 201;
  };
  const JobFinished finished = house.finish(house.newProject());
  ASSERT_EQ(finished.failed.size(), 1u);
  EXPECT_THAT(finished.failed[0].message, HasSubstr("changed"));
}

TEST(Run, WarningsOfAStepAreInItsRecord) {
  FakeHouse house;
  house.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step == "surface.seed"_step && c.frame.value == 0) logWarning("camera left is dark");
    c.scores["count"] = 5;
  };
  house.finish(house.newProject());
  const auto record = house.open().record("surface.seed"_step, FrameIndex{0});
  ASSERT_TRUE(record);
  EXPECT_EQ(record->warnings, (std::vector<std::string>{"camera left is dark"}));
  EXPECT_EQ(record->scores.at("count"), 5);
  EXPECT_EQ(record->device, "Fake device");
  EXPECT_GT(record->peak_memory_bytes, 1000000u);
  EXPECT_TRUE(house.open().record("surface.fit"_step, FrameIndex{0})->warnings.empty());
}

TEST(Run, ProgressGrowsAndEndsBelowOrAtOne) {
  FakeHouse house;
  double last = 0;
  for (const JobEvent& event : house.run(house.newProject())) {
    if (const auto* p = std::get_if<StepProgress>(&event)) {
      EXPECT_GE(p->job_fraction, last - 1e-9);
      last = p->job_fraction;
    }
  }
  EXPECT_NEAR(last, 1, 1e-9);
}

TEST(Run, NothingIsWrittenIntoTheCapture) {
  FakeHouse house;
  const auto before = everythingIn(house.root() / "capture");
  house.finish(house.newProject());
  EXPECT_EQ(everythingIn(house.root() / "capture"), before);
}

// Body runs in a child as a user whom write permissions bind; true when it returned true.
template <class Body>
bool asOrdinaryUser(Body&& body) {
  const pid_t child = ::fork();
  if (child == 0) {
    const bool bound = ::getuid() != 0 || ::setuid(65534) == 0;
    ::_exit(bound && body() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void setWritable(const std::filesystem::path& folder, bool writable) {
  namespace fs = std::filesystem;
  const auto change = [&](const fs::path& p) {
    const auto bits =
        fs::is_directory(p) ? fs::perms(writable ? 0777 : 0555) : fs::perms(writable ? 0666 : 0444);
    fs::permissions(p, bits);
  };
  change(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) change(entry.path());
}

TEST(ReadOnlyProject, CanBeLookedAtAndReusedButNotRun) {
  FakeHouse house;
  house.finish(house.newProject(), {{FrameIndex{0}}, "", ""});
  std::filesystem::permissions(house.root(), std::filesystem::perms(0777));
  setWritable(house.root() / "p.beam", false);
  const auto before = everythingIn(house.root() / "p.beam");
  EXPECT_TRUE(asOrdinaryUser([&] {
    const Project p = house.open();
    return p.readOnly() && p.state("materials.bake"_step, FrameIndex{0}) == StepState::Done &&
           p.state("materials.bake"_step, FrameIndex{1}) == StepState::Pending;
  }));
  EXPECT_TRUE(asOrdinaryUser([&] {
    return house.finish(house.open(), {{FrameIndex{0}}, "", ""}).outcome == JobOutcome::Done;
  }));
  EXPECT_TRUE(asOrdinaryUser([&] {
    const JobFinished finished = house.finish(house.open());
    return finished.outcome == JobOutcome::Failed && finished.kind == Error::Kind::Storage &&
           finished.message.find("read-only") != std::string::npos;
  }));
  EXPECT_TRUE(asOrdinaryUser([&] {
    try {
      Project p = house.open();
      p.set("surface.iterations", 50);
      p.save();
    } catch (const Error& e) {
      return e.kind() == Error::Kind::Storage;
    }
    return false;
  }));
  EXPECT_TRUE(house.open().readOnly());  // for root too: nobody may write means nobody
  EXPECT_EQ(everythingIn(house.root() / "p.beam"), before);
  setWritable(house.root() / "p.beam", true);
}

}  // namespace
}  // namespace beam::testing
