// SPDX-License-Identifier: Apache-2.0
// Cleaning takes what no setting refers to and nothing else, whatever stops it.
#include "core/pipeline/clean_results.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/pipeline/project_report.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Counts = std::map<StepId, int>;

class Clean : public ::testing::Test {
 protected:
  explicit Clean(const std::vector<StageInfo>& stages = fakeStages()) : house_(stages) {}

  fs::path folder(const std::string& name = "p.beam") const { return house_.root() / name; }
  CleanPlan plan(const std::string& name = "p.beam") {
    Progress progress;
    return planClean(house_.open(name), progress);
  }
  CleanPlan clean(const std::string& name = "p.beam") {
    Progress progress;
    return cleanResults(folder(name), house_.setup, progress);
  }
  Error::Kind refusalOf(const std::string& name = "p.beam") {
    try {
      clean(name);
    } catch (const Error& e) {
      said_ = e.what();
      return e.kind();
    }
    ADD_FAILURE() << "was not refused";
    return Error::Kind::Bug;
  }
  void set(const std::string& setting, const FieldValue& value) {
    Project p = house_.open();
    p.set(setting, value);
    p.save();
  }
  void reset(const std::string& setting) {
    Project p = house_.open();
    p.reset(setting);
    p.save();
  }
  Counts countsOf(const RunRequest& request = {}) {
    house_.hooks.computed.clear();
    EXPECT_EQ(house_.finish(house_.open(), request).outcome, JobOutcome::Done);
    return house_.hooks.computed;
  }
  // Solved as it is, and once with another number of iterations in Surface: four results of other settings a
  // frame.
  void solveToAndFro() {
    house_.newProject();
    countsOf();
    set("surface.iterations", 12);
    countsOf();
    reset("surface.iterations");
  }
  static std::map<std::string, std::string> within(const std::map<std::string, std::string>& all,
                                                   const std::map<std::string, std::string>& wanted) {
    std::map<std::string, std::string> some;
    for (const auto& [name, text] : all) {
      if (wanted.contains(name)) some.emplace(name, text);
    }
    return some;
  }

  FakeHouse house_;
  std::string said_;
};

class CleanTakes : public Clean {
 protected:
  CleanTakes() : Clean(fakeStagesWithTakes()) {
    house_.frame_names = {"000", "001", "002", "003", "004", "005"};
    house_.newProject();
  }
  static RunRequest framesOf(std::initializer_list<int> numbers, int every = 1) {
    RunRequest request;
    for (const int n : numbers) request.frames.push_back({n});
    request.every = every;
    return request;
  }
};

TEST_F(Clean, LeavesWhatAProjectHasThatOnlyEverHadTheSettingsInForce) {
  solveToAndFro();
  house_.newProject("only.beam");
  house_.finish(house_.open("only.beam"));
  const auto before = everythingIn(folder() / "results");
  const CleanPlan gone = clean();
  EXPECT_EQ(gone.use.others().count, 3 * 4);
  EXPECT_EQ(gone.use.inForce().count, 2 + 3 * 4);
  EXPECT_EQ(productsOf(folder()), productsOf(folder("only.beam")));
  auto after = everythingIn(folder() / "results"), unchanged = within(before, after);
  EXPECT_EQ(after, unchanged) << "times and all";
  EXPECT_EQ(countsOf(), Counts{});
  EXPECT_EQ(clean().use.others(), DiskAmount{});
}

TEST_F(Clean, ToldToLookAloneTouchesNothingAndSaysTheSame) {
  solveToAndFro();
  const auto before = everythingIn(folder());
  const CleanPlan told = plan();
  EXPECT_EQ(everythingIn(folder()), before);
  EXPECT_EQ(told.use.others().count, 3 * 4);
  const CleanPlan gone = clean();
  EXPECT_EQ(told.freedBytes(), gone.freedBytes());
  EXPECT_EQ(told.use.inForce(), gone.use.inForce());
}

TEST_F(Clean, LooksReferToNoResult) {
  solveToAndFro();
  const std::int64_t without = plan().use.others().count;
  Project p = house_.open();
  Look look;
  look.name = "evening";
  p.setLook(look);
  p.save();
  EXPECT_EQ(plan().use.others().count, without);
}

TEST_F(Clean, ASettingThatComesBackIsSolvedAgain) {
  solveToAndFro();
  clean();
  set("surface.iterations", 12);
  EXPECT_EQ(countsOf().at("surface.fit"_step), 3);
}

TEST_F(Clean, CountsEveryByteOnce) {
  solveToAndFro();
  const DiskUse use = plan().use;
  EXPECT_EQ(use.inForce().bytes + use.others().bytes, bytesBelow(folder() / "results"));
  std::uint64_t bytes = 0;
  for (const ResultUse& result : use.results) bytes += result.bytes;
  EXPECT_EQ(bytes, bytesBelow(folder() / "results"));
  EXPECT_EQ(clean().freedBytes(), use.others().bytes);
  EXPECT_EQ(bytesBelow(folder() / "results"), use.inForce().bytes);
}

TEST_F(CleanTakes, LeadsOfSegmentsStay) {
  RunRequest request = framesOf({3, 4, 5});
  request.overlap = 2;
  countsOf(request);
  EXPECT_EQ(clean().use.others(), DiskAmount{});
  EXPECT_EQ(countsOf(request), Counts{});
  countsOf();
  EXPECT_EQ(clean().use.others(), DiskAmount{}) << "the seam still builds on them";
  EXPECT_EQ(countsOf(), Counts{});
}

TEST_F(CleanTakes, AFrameBetweenTwoOfAScoutKeepsWhatItHasAlone) {
  countsOf(framesOf({}, 2));
  countsOf(framesOf({1}));
  EXPECT_EQ(clean().use.others(), DiskAmount{});
  EXPECT_EQ(countsOf(framesOf({}, 2)), Counts{});
  EXPECT_EQ(countsOf(framesOf({1})), Counts{});
}

TEST_F(CleanTakes, WhatLaterFramesBuildOnStaysThoughAnotherTakeClaimsIt) {
  countsOf();
  countsOf(framesOf({2, 3}));
  EXPECT_EQ(clean().use.others().count, 2) << "frames 2 and 3 are baked anew, nothing builds on the old ones";
  EXPECT_EQ(countsOf(framesOf({2, 3})), Counts{});
  EXPECT_EQ(countsOf(), (Counts{{"materials.bake"_step, 2}})) << "the take is whole again";
}

TEST_F(CleanTakes, ATakeThatOwnsNoFrameKeepsNothing) {
  countsOf(framesOf({0, 1, 2, 3}));
  countsOf(framesOf({0}));
  countsOf(framesOf({1, 2}));
  countsOf(framesOf({3}));
  clean();
  house_.newProject("only.beam");
  for (const auto& frames : {framesOf({0}), framesOf({1, 2}), framesOf({3})})
    house_.finish(house_.open("only.beam"), frames);
  EXPECT_EQ(productsOf(folder()), productsOf(folder("only.beam")));
}

TEST_F(Clean, APanoramaThatIsGoneForTheMomentCostsNothing) {
  Project p = house_.newProject();
  std::ofstream(house_.root() / "other.hdr") << "other light";
  p.setEnvironment(house_.root() / "other.hdr");
  p.save();
  countsOf();
  fs::rename(house_.root() / "other.hdr", house_.root() / "away.hdr");
  const auto before = everythingIn(folder());
  EXPECT_EQ(refusalOf(), Error::Kind::Data);
  EXPECT_THAT(said_, AllOf(HasSubstr("other.hdr"), HasSubstr("put it back")));
  Progress progress;
  EXPECT_THROW(planClean(house_.open(), progress), Error);
  EXPECT_EQ(everythingIn(folder()), before);
  fs::rename(house_.root() / "away.hdr", house_.root() / "other.hdr");
  EXPECT_EQ(clean().use.others(), DiskAmount{});
}

TEST_F(Clean, ACaptureThatIsGoneCostsNothing) {
  solveToAndFro();
  fs::rename(house_.root() / "capture", house_.root() / "away");
  const auto before = everythingIn(folder());
  EXPECT_EQ(refusalOf(), Error::Kind::Data);
  EXPECT_THAT(said_, AllOf(HasSubstr("capture"), HasSubstr("put it back")));
  EXPECT_EQ(everythingIn(folder()), before);
}

TEST_F(Clean, AFolderThatIsNamedLikeALeaseStopsNothing) {
  solveToAndFro();
  const fs::path odd = folder() / "leases" / std::string(32, 'a') / "b";
  fs::create_directories(odd);
  EXPECT_EQ(clean().use.others().count, 3 * 4);
  EXPECT_TRUE(fs::exists(odd)) << "nobody's to remove";
}

TEST_F(Clean, SaysWhichCamerasAreGone) {
  solveToAndFro();
  EXPECT_THAT(plan().gone, IsEmpty()) << "of other settings alone";
  const auto open = house_.setup->open_capture;
  house_.setup->open_capture = [&](const auto& folder, const auto& options) {
    ImportedCapture imported = open(folder, options);
    imported.set.views.pop_back();
    return imported;
  };
  std::ofstream(house_.root() / "capture/dataset.json") << "{ }";
  EXPECT_THAT(plan().gone, ::testing::Contains(HasSubstr("dataset.json")));
  EXPECT_THAT(plan().gone, ::testing::Contains("the picture top")) << "a capture without files";
}

TEST_F(Clean, ATakeOfAFrameThatIsNotThereCostsNothing) {
  solveToAndFro();
  house_.frame_names.pop_back();
  Project p = house_.open();
  ProjectDocument document = p.document();
  document.takes = {{"000", "nowhere", 1, 0}};
  std::ofstream(folder() / "project.json") << toJson(document);
  EXPECT_EQ(refusalOf(), Error::Kind::Data);
  EXPECT_THAT(said_, HasSubstr("no frame nowhere"));
}

TEST_F(Clean, APictureThatCannotBeReadCostsNothing) {
  class OddFrames final : public FrameSource {
   public:
    explicit OddFrames(std::string folder) : folder_(std::move(folder)) {}
    bool has(ViewIndex, FrameIndex) const override { return true; }
    std::vector<std::string> files(ViewIndex, FrameIndex) const override { return {folder_}; }
    Image<u8vec3> photo(ViewIndex, FrameIndex) const override { return Image<u8vec3>(4, 4, u8vec3(9)); }
    Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return {}; }

   private:
    std::string folder_;
  };
  solveToAndFro();
  const auto open = house_.setup->open_capture;
  house_.setup->open_capture = [&](const auto& folder, const auto& options) {
    ImportedCapture imported = open(folder, options);
    imported.set.source = std::make_shared<OddFrames>(house_.root().string());
    return imported;
  };
  EXPECT_EQ(refusalOf(), Error::Kind::Data);
  EXPECT_THAT(said_, AllOf(HasSubstr("and 8 more"), HasSubstr("cannot be read")));
}

TEST_F(Clean, AStageThatIsBlockedKeepsAllThereIsOfItAndWhatThatWasMadeFrom) {
  house_.newProject();
  countsOf();
  set("surface.iterations", 12);
  countsOf({.until = "surface"});
  house_.has_panorama = false;
  const CleanPlan kept = clean();
  EXPECT_EQ(kept.use.others(), DiskAmount{}) << "the old surface is what the materials were made from";
  EXPECT_THAT(diskText(kept.use), HasSubstr("blocked"));
  house_.has_panorama = true;
  EXPECT_EQ(clean().use.others().count, 3 * 4) << "the surface and materials of before";
}

TEST_F(Clean, WaitsForWhoeverComputes) {
  solveToAndFro();
  const Project p = house_.open();
  {
    const auto lease = p.store().tryLease(digestOf("anything"));
    const auto before = productsOf(folder());
    EXPECT_EQ(refusalOf(), Error::Kind::Locked);
    EXPECT_THAT(said_, AllOf(HasSubstr(fmt::format("process {}", ::getpid())), HasSubstr("wait until")));
    EXPECT_EQ(productsOf(folder()), before);
  }
  EXPECT_EQ(clean().use.others().count, 3 * 4);
}

TEST_F(Clean, NobodySavesMeanwhileAndItWaitsForWhoeverDoes) {
  solveToAndFro();
  const FileLock saving = lockProject(folder());
  const auto before = productsOf(folder());
  EXPECT_EQ(refusalOf(), Error::Kind::Locked);
  EXPECT_EQ(productsOf(folder()), before);
}

TEST_F(Clean, ATrashFolderOfACleanThatWasKilledGoesWithTheNext) {
  solveToAndFro();
  const CleanPlan first = plan();
  for (const ResultUse& result : first.use.results) {
    if (result.in_force) continue;
    const fs::path aside = folder() / "results" / fmt::format(".{}.123.tmp", result.key.hex());
    fs::rename(folder() / "results" / result.key.hex(), aside);
    fs::remove(aside / "data.txt");
    break;
  }
  EXPECT_EQ(house_.open().stageState("materials", {0}), StepState::Done);
  const CleanPlan rest = clean();
  EXPECT_EQ(rest.half_built.count, 1);
  EXPECT_EQ(rest.use.others().count, first.use.others().count - 1);
  EXPECT_EQ(rest.use.inForce(), first.use.inForce());
  EXPECT_EQ(bytesBelow(folder() / "results"), first.use.inForce().bytes);
  EXPECT_EQ(countsOf(), Counts{});
}

TEST_F(Clean, AStopAtAnyStepCostsNothingInForceAndTheNextTimeFinishes) {
  solveToAndFro();
  const CleanPlan whole = plan();
  int stopped = 0;
  for (int after = 0;; ++after) {
    std::stop_source stop;
    int reports = 0;
    Progress progress(stop.get_token(), [&](const ProgressReport& report) {
      if (!report.label.starts_with("looking") && reports++ == after) stop.request_stop();
    });
    try {
      cleanResults(folder(), house_.setup, progress);
      break;
    } catch (const Cancelled&) {
      ++stopped;
    }
    ASSERT_LT(after, 100);
    for (const ResultUse& result : whole.use.results)
      EXPECT_TRUE(!result.in_force || ResultStore(folder()).verified(result.key));
  }
  EXPECT_GT(stopped, 1);
  EXPECT_EQ(bytesBelow(folder() / "results"), whole.use.inForce().bytes);
}

TEST_F(Clean, TakesNotesDamagedResultsAndLeasesThatNobodyNeeds) {
  house_.newProject();
  house_.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step == "surface.refine"_step && c.frame.value == 2) throw Error(Error::Kind::Data, "too dark");
  };
  house_.finish(house_.open());
  set("surface.iterations", 12);
  house_.finish(house_.open());
  const Project p = house_.open();
  const fs::path damaged = *p.result("surface.refine"_step, {0});
  fs::resize_file(damaged / "data.txt", 3);
  EXPECT_FALSE(p.result("surface.refine"_step, {0}));
  std::ofstream(folder() / "leases" / digestOf("killed").hex()) << "host h, process 1\n";
  std::ofstream(folder() / "quarantine" / "mine.txt") << "of somebody else";
  fs::create_directory(folder() / "results" / digestOf("nothing in it").hex());
  const CleanPlan gone = clean();
  EXPECT_EQ(gone.failures.size(), 1u);
  EXPECT_EQ(gone.set_aside.count, 1);
  EXPECT_EQ(gone.leases.size(), 1u);
  EXPECT_EQ(gone.use.stages.back().title, "not readable");
  EXPECT_THAT(p.store().leases(), IsEmpty());
  EXPECT_THAT(p.store().setAside(), IsEmpty());
  EXPECT_TRUE(fs::exists(folder() / "quarantine" / "mine.txt"));
  EXPECT_EQ(house_.open().state("surface.refine"_step, {2}), StepState::Failed) << "its note is in force";
  const CleanPlan again = plan();
  EXPECT_EQ(again.freedBytes(), 0u);
  EXPECT_TRUE(again.failures.empty() && again.leases.empty());
}

TEST_F(Clean, OfAReadOnlyProjectIsRefused) {
  solveToAndFro();
  fs::permissions(folder(), fs::perms(0555));
  EXPECT_EQ(refusalOf(), Error::Kind::Storage);
  EXPECT_THAT(said_, HasSubstr("read-only"));
  EXPECT_EQ(plan().use.others().count, 3 * 4) << "looking is allowed";
  fs::permissions(folder(), fs::perms(0755));
}

TEST_F(Clean, OfANewProjectFindsNothing) {
  house_.newProject();
  const CleanPlan gone = clean();
  EXPECT_EQ(gone.freedBytes(), 0u);
  EXPECT_EQ(diskText(gone.use), "");
}

TEST_F(Clean, StatusTellsInForceAndOthersApart) {
  solveToAndFro();
  const DiskUse use = plan().use;
  EXPECT_THAT(diskText(use), AllOf(HasSubstr("\n  surface  "), HasSubstr(" not in force (beam clean)")));
  EXPECT_THAT(diskJson(use), AllOf(HasSubstr("\"in_force\""), HasSubstr("\"other\"")));
  clean();
  EXPECT_EQ(diskText(plan().use).find("not in force"), std::string::npos);
}

TEST(SizeText, IsShortAndHasAUnit) {
  EXPECT_EQ(sizeText(0), "0 kB");
  EXPECT_EQ(sizeText(1), "1 kB");
  EXPECT_EQ(sizeText(12'345), "12 kB");
  EXPECT_EQ(sizeText(999'000), "999 kB");
  EXPECT_EQ(sizeText(999'600), "1.0 MB");
  EXPECT_EQ(sizeText(99'949'999), "99.9 MB");
  EXPECT_EQ(sizeText(210'400'000), "210 MB");
  EXPECT_EQ(sizeText(999'600'000), "1.0 GB");
  EXPECT_EQ(sizeText(123'400'000'000), "123.4 GB");
}

}  // namespace
}  // namespace beam::testing
