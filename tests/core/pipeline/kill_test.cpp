// SPDX-License-Identifier: Apache-2.0
// kill -9 at any moment, of a clean as well, and several writers at once: nothing that was acknowledged is
// lost, nothing half-written is seen, and the bytes are those of an undisturbed run.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <set>
#include <thread>

#include "core/base/rng.h"
#include "core/pipeline/clean_results.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using namespace std::chrono_literals;

// Runs the project in a child, which writes every acknowledged key to `pipe`.
pid_t runInChild(FakeHouse& house, int acknowledged) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  for (const JobEvent& event : house.run(house.open())) {
    const auto* step = std::get_if<StepFinished>(&event);
    if (step && !step->reused) {
      const std::string line = step->key.hex();
      if (::write(acknowledged, line.data(), line.size()) < 0) ::_exit(3);
    }
    if (const auto* end = std::get_if<JobFinished>(&event)) ::_exit(end->outcome == JobOutcome::Done ? 0 : 1);
  }
  ::_exit(2);
}

// Events as they come, so that what is acknowledged before a kill is known.
pid_t runInChildLive(FakeHouse& house, int acknowledged) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  Runner runner;
  runner.start(house.open(), {}, std::make_shared<FakeDevice>());
  for (;;) {
    const auto event = runner.waitPop(100ms);
    if (!event) continue;
    const auto* step = std::get_if<StepFinished>(&*event);
    if (step && !step->reused) {
      const std::string line = step->key.hex();
      if (::write(acknowledged, line.data(), line.size()) < 0) ::_exit(3);
    }
    if (const auto* end = std::get_if<JobFinished>(&*event))
      ::_exit(end->outcome == JobOutcome::Done ? 0 : 1);
  }
}

std::set<std::string> keysFrom(int pipe) {
  std::set<std::string> keys;
  char line[32];
  while (::read(pipe, line, sizeof line) == static_cast<ssize_t>(sizeof line))
    keys.emplace(line, sizeof line);
  return keys;
}

int exitOf(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

struct Pipe {
  int ends[2] = {-1, -1};
  Pipe() {
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  }
  void closeWriting() {
    ::close(ends[1]);
    ends[1] = -1;
  }
  ~Pipe() {
    ::close(ends[0]);
    if (ends[1] >= 0) ::close(ends[1]);
  }
};

TEST(Kill, AtAnyMomentLosesNothingThatWasAcknowledged) {
  FakeHouse house;
  house.hooks.at_step = [](const StepId&, StepContext& c) {
    std::ofstream(c.folder / "early.txt") << "early";  // so that a kill finds something half done
    std::this_thread::sleep_for(500us);
  };
  house.newProject("calm.beam");
  ASSERT_EQ(house.finish(house.open("calm.beam")).outcome, JobOutcome::Done);
  const auto calm = productsOf(house.root() / "calm.beam");

  const RandomStream random(11);
  int cut_short = 0;
  for (int trial = 0; trial < 10; ++trial) {
    std::filesystem::remove_all(house.root() / "p.beam");
    house.newProject();
    std::set<std::string> acknowledged;
    for (int attempt = 0;; ++attempt) {
      ASSERT_LT(attempt, 400);
      Pipe pipe;
      const pid_t child = runInChildLive(house, pipe.ends[1]);
      pipe.closeWriting();
      // Later attempts get more time, so that every trial comes to its end.
      std::this_thread::sleep_for(std::chrono::microseconds(
          random.below(static_cast<std::uint64_t>(trial * 1000 + attempt), 20000) + 1000 * attempt));
      ::kill(child, SIGKILL);
      const std::set<std::string> now = keysFrom(pipe.ends[0]);
      acknowledged.insert(now.begin(), now.end());
      const int code = exitOf(child);
      for (const std::string& key : acknowledged) {
        EXPECT_TRUE(ResultStore(house.root() / "p.beam").verified(parseDigest(key))) << key;
      }
      if (code == 0) break;
      ASSERT_EQ(code, -SIGKILL);
      ++cut_short;
    }
    ASSERT_EQ(house.finish(house.open()).computed, 0);
    EXPECT_EQ(productsOf(house.root() / "p.beam"), calm) << "trial " << trial;
    for (const auto& entry : std::filesystem::directory_iterator(house.root() / "p.beam" / "results")) {
      EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
    }
    EXPECT_FALSE(std::filesystem::exists(house.root() / "p.beam" / "quarantine"));
  }
  EXPECT_GT(cut_short, 5);
}

TEST(Kill, InTheMiddleOfACleanCostsNoResultInForceAndTheNextFinishes) {
  FakeHouse house;
  house.newProject();
  house.finish(house.open());
  const auto calm = productsOf(house.root() / "p.beam");
  const RandomStream random(12);
  int cut_short = 0;
  for (int trial = 0; trial < 20; ++trial) {
    for (const int iterations : {12, 13, 14}) {
      Project other = house.open();
      other.set("surface.iterations", iterations);
      other.save();
      house.finish(house.open());
    }
    Project own = house.open();
    own.reset("surface.iterations");
    own.save();
    const pid_t child = ::fork();
    if (child == 0) {
      Progress progress;
      cleanResults(house.root() / "p.beam", house.setup, progress);
      ::_exit(0);
    }
    std::this_thread::sleep_for(
        std::chrono::microseconds(random.below(static_cast<std::uint64_t>(trial), 10000)));
    ::kill(child, SIGKILL);
    cut_short += exitOf(child) == -SIGKILL;
    ASSERT_EQ(house.finish(house.open()).computed, 0) << "trial " << trial;
    Progress progress;
    cleanResults(house.root() / "p.beam", house.setup, progress);
    EXPECT_EQ(productsOf(house.root() / "p.beam"), calm) << "trial " << trial;
    EXPECT_FALSE(std::filesystem::exists(house.root() / "p.beam" / "quarantine"));
  }
  EXPECT_GT(cut_short, 0);
}

TEST(Writers, ThatRunAtOnceComputeEachStepOnceAndAgree) {
  FakeHouse house;
  house.hooks.at_step = [](const StepId&, StepContext&) { std::this_thread::sleep_for(2ms); };
  house.newProject("calm.beam");
  house.finish(house.open("calm.beam"));
  house.newProject();
  Pipe pipe;
  std::vector<pid_t> children;
  for (int i = 0; i < 3; ++i) children.push_back(runInChild(house, pipe.ends[1]));
  for (const pid_t child : children) EXPECT_EQ(exitOf(child), 0);
  pipe.closeWriting();
  int computed = 0;
  char line[32];
  while (::read(pipe.ends[0], line, sizeof line) == static_cast<ssize_t>(sizeof line)) ++computed;
  EXPECT_EQ(computed, 2 + 3 * 4);
  EXPECT_EQ(productsOf(house.root() / "p.beam"), productsOf(house.root() / "calm.beam"));
}

TEST(Writers, AStepThatSomebodyElseComputesShowsAsRunning) {
  FakeHouse house;
  const Project p = house.newProject();
  const auto lease = p.store().tryLease(p.key("surface.fit"_step, FrameIndex{1}));
  EXPECT_EQ(p.state("surface.fit"_step, FrameIndex{1}), StepState::Running);
  EXPECT_EQ(p.state("surface.fit"_step, FrameIndex{0}), StepState::Pending);
}

}  // namespace
}  // namespace beam::testing
