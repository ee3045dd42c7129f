// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/copy_project.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/pipeline/take_survey.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;

TEST(CopyProject, HasTheSameResultsUnderAnIdOfItsOwn) {
  FakeHouse house;
  Project from = house.newProject();
  house.finish(from);
  from.set("surface.batch", 7);  // not saved
  Progress progress;
  copyProject(from, house.root() / "deep" / "q.beam", true, progress);
  const Project to = Project::open(house.root() / "deep" / "q.beam", house.setup);
  EXPECT_NE(to.document().id, from.document().id);
  EXPECT_EQ(to.document().id.size(), 32u);
  EXPECT_EQ(std::get<int>(to.value("surface.batch")), 7);
  EXPECT_EQ(to.captureFolder(), house.root() / "capture");
  EXPECT_EQ(productsOf(to.folder()), productsOf(from.folder()));
  for (const int f : {0, 1, 2}) EXPECT_EQ(to.stageState("materials", FrameIndex{f}), StepState::Done);
  EXPECT_TRUE(to.result("surface.fit"_step, FrameIndex{1})) << "every byte verified";
  house.hooks.computed.clear();
  house.finish(to);
  EXPECT_TRUE(house.hooks.computed.empty());
}

TEST(CopyProject, KeepsTheAgeOfResultsAndWhyAFrameFailed) {
  FakeHouse house;
  const Project from = house.newProject();
  house.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step == "surface.fit"_step && c.frame.value == 2) throw Error(Error::Kind::Data, "too dark");
  };
  house.finish(from);
  const Digest key = from.key("surface.fit"_step, FrameIndex{1});
  const auto age = fs::last_write_time(from.store().folderOf(key) / "result.json") - std::chrono::hours(5);
  fs::last_write_time(from.store().folderOf(key) / "result.json", age);
  Progress progress;
  copyProject(from, house.root() / "q.beam", true, progress);
  const Project to = house.open("q.beam");
  EXPECT_EQ(fs::last_write_time(to.store().folderOf(key) / "result.json"), age);
  EXPECT_EQ(to.failureOf("surface.fit"_step, FrameIndex{2}), "too dark");
}

TEST(CopyProject, IsNotMadeInTheCapture) {
  FakeHouse house;
  const Project from = house.newProject();
  Progress progress;
  EXPECT_THROW(copyProject(from, house.root() / "capture" / "q.beam", true, progress), Error);
  EXPECT_FALSE(fs::exists(house.root() / "capture" / "q.beam"));
}

TEST(CopyProject, WithoutResultsIsTheSettingsAlone) {
  FakeHouse house;
  Project from = house.newProject();
  house.finish(from);
  fs::create_directories(house.root() / "q.beam");  // an empty folder may be taken
  Progress progress;
  copyProject(from, house.root() / "q.beam", false, progress);
  EXPECT_FALSE(fs::exists(house.root() / "q.beam" / "results"));
  EXPECT_EQ(house.open("q.beam").stageState("surface", FrameIndex{0}), StepState::Pending);
}

TEST(CopyProject, OfAProjectThatIsNotOnDiskYetWorksToo) {
  FakeHouse house;
  Project from = Project::create(house.root() / "new.beam", {}, house.setup);
  from.setCapture(house.root() / "capture");
  Progress progress;
  copyProject(from, house.root() / "q.beam", true, progress);
  EXPECT_EQ(house.open("q.beam").captureFolder(), house.root() / "capture");
  EXPECT_FALSE(fs::exists(house.root() / "new.beam"));
}

TEST(CopyProject, LeavesAHalfBuiltResultBehind) {
  FakeHouse house;
  const Project from = house.newProject();
  house.finish(from);
  fs::remove(*from.result("materials.bake"_step, FrameIndex{0}) / "data.txt");
  fs::create_directories(from.folder() / "results" / ".00000000000000000000000000000000.1.tmp");
  Progress progress;
  copyProject(from, house.root() / "q.beam", true, progress);
  EXPECT_EQ(house.open("q.beam").store().keys().size() + 1, from.store().keys().size());
  for (const auto& entry : fs::directory_iterator(house.root() / "q.beam" / "results"))
    EXPECT_NE(entry.path().filename().string().front(), '.');
}

TEST(CopyProject, RefusesFoldersThatAreInUseOrInsideOrAround) {
  FakeHouse house;
  const Project from = house.newProject();
  fs::create_directories(house.root() / "mine");
  std::ofstream(house.root() / "mine" / "letter.txt") << "dear";
  fs::create_directory_symlink(from.folder(), house.root() / "again");
  const auto before = everythingIn(house.root());
  Progress progress;
  for (const fs::path& to :
       {house.root() / "mine", from.folder(), from.folder() / "inner" / "q.beam", house.root(),
        house.root() / "again" / "q.beam", from.folder() / ".." / "p.beam", from.folder() / ""}) {
    try {
      copyProject(from, to, true, progress);
      ADD_FAILURE() << to;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), Error::Kind::Usage) << to << ": " << e.what();
    }
  }
  EXPECT_EQ(everythingIn(house.root()), before);
}

TEST(CopyProject, AStoppedCopyLeavesNothing) {
  FakeHouse house;
  const Project from = house.newProject();
  house.finish(from);
  const auto before = everythingIn(house.root());
  std::stop_source stop;
  int reports = 0;
  Progress progress(stop.get_token(), [&](const ProgressReport&) {
    ++reports;
    stop.request_stop();
  });
  EXPECT_THROW(copyProject(from, house.root() / "q.beam", true, progress), Cancelled);
  EXPECT_GT(reports, 0);
  EXPECT_FALSE(Project::isProject(house.root() / "q.beam"));
  EXPECT_EQ(everythingIn(house.root()), before);
}

}  // namespace
}  // namespace beam::testing
