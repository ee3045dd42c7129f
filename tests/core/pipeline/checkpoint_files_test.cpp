// SPDX-License-Identifier: Apache-2.0
// Checkpoints: whole or not at all, the one before where the newest is damaged, gone with the result.
#include "core/pipeline/checkpoint_files.h"

#include <gtest/gtest.h>

#include "core/base/log.h"
#include "core/pipeline/clean_results.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

void keep(Checkpoint& checkpoint, int value, std::stop_token stop = {}) {
  CheckpointWriter writer;
  const std::vector<int> many(100000, value);
  writer.give(std::vector<int>{value});
  writer.lend(many);
  checkpoint.keep(writer, Progress(std::move(stop)));
}

// 0: nothing is kept.
int keptIn(const Checkpoint& checkpoint) {
  const std::unique_ptr<CheckpointReader> reader = checkpoint.kept();
  if (!reader) return 0;
  const int value = reader->list<int>().at(0);
  EXPECT_EQ(reader->list<int>(), std::vector<int>(100000, value));
  EXPECT_THROW(reader->list<int>(), Error);
  return value;
}

void damage(const fs::path& file) {
  std::fstream f(file, std::ios::in | std::ios::out | std::ios::binary);
  f.seekp(20000);
  f.put('!');
}

TEST(Checkpoints, AreReadBackWholeAndTheNewestFirst) {
  const TempDir folder;
  CheckpointFiles checkpoint(folder.path() / "checkpoints" / "k", 0ms);
  EXPECT_EQ(keptIn(checkpoint), 0);
  for (const int value : {1, 2, 3}) {
    keep(checkpoint, value);
    EXPECT_EQ(keptIn(checkpoint), value);
  }
}

TEST(Checkpoints, ThatAreDamagedOrCutGiveTheOneBeforeOrNone) {
  const TempDir folder;
  CheckpointFiles checkpoint(folder.path(), 0ms);
  keep(checkpoint, 1);
  keep(checkpoint, 2);
  damage(folder.path() / "newest");
  EXPECT_EQ(keptIn(checkpoint), 1);
  for (const int bytes : {0, 7, 39, 40, 5000}) {
    fs::resize_file(folder.path() / "older", static_cast<std::uintmax_t>(bytes));
    EXPECT_EQ(keptIn(checkpoint), 0) << bytes;
  }
  keep(checkpoint, 3);
  EXPECT_EQ(keptIn(checkpoint), 3);
}

TEST(Checkpoints, ThatAStopCutsOffLeaveTheOneBefore) {
  const TempDir folder;
  CheckpointFiles checkpoint(folder.path(), 0ms);
  keep(checkpoint, 1);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(keep(checkpoint, 2, stop.get_token()), Cancelled);
  EXPECT_EQ(keptIn(checkpoint), 1);
}

TEST(Checkpoints, ThatADiskDoesNotTakeAreWarnedOfOnceAndEndNothing) {
  const TempDir folder;
  std::ofstream(folder.path() / "file") << "in the way";
  int warnings = 0;
  const int sink = addLogSink([&](const LogRecord& r) { warnings += r.level == LogLevel::Warning; });
  CheckpointFiles checkpoint(folder.path() / "file" / "k", 0ms);
  keep(checkpoint, 1);
  keep(checkpoint, 2);
  removeLogSink(sink);
  EXPECT_EQ(warnings, 1);
  EXPECT_EQ(keptIn(checkpoint), 0);
}

TEST(Checkpoints, AreDueAfterTheTimeThatWasAskedFor) {
  const TempDir folder;
  EXPECT_TRUE(CheckpointFiles(folder.path(), 0ms).due());
  EXPECT_FALSE(CheckpointFiles(folder.path(), 1h).due());
}

TEST(Checkpoints, OutliveAStopAndGoWithTheResult) {
  FakeHouse house;
  house.hooks.at_step = [](const StepId& id, StepContext& c) {
    if (id != "surface.fit"_step || c.frame != FrameIndex{1}) return;
    ASSERT_NE(c.checkpoint, nullptr);
    EXPECT_EQ(keptIn(*c.checkpoint), 0);
    keep(*c.checkpoint, 7);
    throw Cancelled();
  };
  const Project p = house.newProject();
  ASSERT_EQ(house.finish(house.open()).outcome, JobOutcome::Cancelled);
  const Digest key = p.key("surface.fit"_step, FrameIndex{1});
  EXPECT_EQ(p.store().checkpoints(), std::vector<Digest>{key});
  Progress progress;
  EXPECT_EQ(planClean(house.open(), progress).half_built.count, 0) << "a run will go on from it";

  int seen = 0;
  house.hooks.at_step = [&](const StepId& id, StepContext& c) {
    if (id == "surface.fit"_step && c.frame == FrameIndex{1}) seen = keptIn(*c.checkpoint);
  };
  ASSERT_EQ(house.finish(house.open()).outcome, JobOutcome::Done);
  EXPECT_EQ(seen, 7);
  EXPECT_TRUE(p.store().checkpoints().empty());
}

TEST(Checkpoints, OfSettingsThatWereLeftGoWithAClean) {
  FakeHouse house;
  house.hooks.at_step = [](const StepId& id, StepContext& c) {
    if (id != "surface.fit"_step) return;
    keep(*c.checkpoint, 7);
    throw Cancelled();
  };
  house.newProject();
  house.finish(house.open());
  Project other = house.open();
  other.set("surface.iterations", 12);
  other.save();
  Progress progress;
  const CleanPlan plan = planClean(house.open(), progress);
  EXPECT_EQ(plan.checkpoints.size(), 1u);
  EXPECT_EQ(plan.half_built.count, 1);
  EXPECT_GT(plan.half_built.bytes, 400000u);
  cleanResults(house.root() / "p.beam", house.setup, progress);
  EXPECT_TRUE(other.store().checkpoints().empty());
}

}  // namespace
}  // namespace beam::testing
