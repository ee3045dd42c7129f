// SPDX-License-Identifier: Apache-2.0
// Runs over takes: who waits for whom, and what is left when a frame fails.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "core/pipeline/file_lock.h"
#include "core/pipeline/project_report.h"
#include "core/pipeline/run_estimate.h"
#include "core/pipeline/run_plan.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace std::chrono_literals;
using Counts = std::map<StepId, int>;

class TakeRun : public ::testing::Test {
 protected:
  explicit TakeRun(int frames = 6) {
    house_.frame_names.clear();
    for (int i = 0; i < frames; ++i) house_.frame_names.push_back(fmt::format("{:03}", i));
  }
  static RunRequest framesOf(std::initializer_list<int> numbers, int every = 1) {
    RunRequest request;
    for (const int n : numbers) request.frames.push_back({n});
    request.every = every;
    return request;
  }
  Counts countsOf(const RunRequest& request, const std::string& project = "p.beam") {
    house_.hooks.computed.clear();
    EXPECT_EQ(house_.finish(house_.open(project), request).outcome, JobOutcome::Done);
    return house_.hooks.computed;
  }
  std::vector<SavedTake> saved() { return house_.open().document().takes; }

  FakeHouse house_{fakeStagesWithTakes()};
};

TEST_F(TakeRun, AWholeRunMakesSegmentsAndFitsTheFirstFrameOfEach) {
  house_.newProject();
  RunRequest request;
  request.segment_frames = 4;
  EXPECT_EQ(countsOf(request), (Counts{{"capture.import"_step, 1},
                                       {"track.pose"_step, 6},
                                       {"surface.fit"_step, 2},
                                       {"surface.refine"_step, 6},
                                       {"materials.bake"_step, 6}}));
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "003", 1}, SavedTake{"004", "005", 1}));
  EXPECT_EQ(countsOf(request), Counts{});
}

TEST_F(TakeRun, NamedFramesAreTakesAndALoneOneIsNotTracked) {
  house_.newProject();
  EXPECT_EQ(countsOf(framesOf({4})), (Counts{{"capture.import"_step, 1},
                                             {"surface.fit"_step, 1},
                                             {"surface.refine"_step, 1},
                                             {"materials.bake"_step, 1}}));
  EXPECT_EQ(countsOf(framesOf({0, 1, 4})), (Counts{{"track.pose"_step, 2},
                                                   {"surface.fit"_step, 1},
                                                   {"surface.refine"_step, 2},
                                                   {"materials.bake"_step, 2}}));
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "001", 1}));
  EXPECT_EQ(countsOf({}),
            (Counts{{"track.pose"_step, 4}, {"surface.refine"_step, 4}, {"materials.bake"_step, 4}}))
      << "the take goes on; frame 4 is no longer alone";
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "005", 1}));
}

TEST_F(TakeRun, AFrameOfASolvedTakeStaysInItWhereThatIsWanted) {
  house_.newProject();
  countsOf(framesOf({0, 1, 2, 3}));
  RunRequest third = framesOf({3});
  third.keeps_takes = true;
  EXPECT_EQ(countsOf(third), Counts{});
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "003", 1}));
  RunRequest beyond = framesOf({3, 4});
  beyond.keeps_takes = true;
  countsOf(beyond);
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "003", 1}, SavedTake{"003", "004", 1}));
  EXPECT_EQ(countsOf(framesOf({2})).at("surface.fit"_step), 1) << "without the wish it is fitted alone";
}

TEST_F(TakeRun, AFrameIsFittedAloneWhereWhatItBuildsOnIsNotSolved) {
  house_.newProject();
  countsOf(framesOf({0, 1, 2, 3}));
  Project changed = house_.open();
  changed.set("surface.iterations", FieldValue(12));
  changed.save();
  RunRequest third = framesOf({3});
  third.keeps_takes = true;
  const RunEstimate estimate = estimateRun(house_.open(), third, {});
  EXPECT_TRUE(estimate.leaves_take);
  EXPECT_THAT(toText(estimate), HasSubstr("note: a frame of a take is solved alone here"));
  EXPECT_FALSE(estimateRun(house_.open(), framesOf({0}), {}).leaves_take) << "nothing is before it";
  const Counts counts = countsOf(third);
  EXPECT_EQ(counts.at("surface.fit"_step), 1);
  EXPECT_FALSE(counts.contains("track.pose"_step));
}

TEST_F(TakeRun, EveryKthFrameIsATakeWithAStride) {
  house_.newProject();
  const Counts counts = countsOf(framesOf({}, 2));
  EXPECT_EQ(counts.at("surface.refine"_step), 3);
  EXPECT_EQ(counts.at("surface.fit"_step), 1);
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "004", 2}));
  EXPECT_EQ(house_.open().state("surface.refine"_step, {1}), StepState::Pending);
  countsOf(framesOf({1, 2, 3, 5}, 2));
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "004", 2}, SavedTake{"001", "003", 2}));
  EXPECT_EQ(house_.finish(house_.open(), framesOf({}, 0)).kind, Error::Kind::Usage);
}

TEST_F(TakeRun, AReadOnlyProjectKeepsTakesInMemory) {
  Project p = house_.newProject();
  std::filesystem::permissions(p.folder(), std::filesystem::perms(0555));
  const auto before = everythingIn(p.folder());
  arrangeTakes(p, {});
  EXPECT_THAT(p.takes(), ElementsAre(Take{{0}, {5}, 1}));
  p.readTakesAgain();
  p.splitTake({{0}, {5}, 1}, {4});
  EXPECT_THAT(p.takes(), ElementsAre(Take{{0}, {3}, 1}, Take{{4}, {5}, 1, 0, true}));
  std::filesystem::permissions(p.folder(), std::filesystem::perms(0755));
  EXPECT_EQ(everythingIn(p.folder()), before);
  EXPECT_THAT(saved(), ::testing::IsEmpty());
}

TEST_F(TakeRun, StatusTellsTakesAndStepsThatAreNotNeeded) {
  house_.newProject();
  countsOf(framesOf({0, 1, 2}));
  const std::string text = statusText(house_.open()), json = statusJson(house_.open());
  EXPECT_THAT(text, HasSubstr("takes 000 to 002\n"));
  EXPECT_THAT(text, HasSubstr("done 000, 001, 002; not needed (3 frames: solved alone, in no take)"));
  EXPECT_THAT(json, HasSubstr("\"state\": \"not needed\""));
}

TEST_F(TakeRun, AnyStageTakesAlongWhatItsFramesBeforeNeed) {
  const RunPlan plan = makeRunPlan(house_.newProject(), {.stage = "materials"});
  EXPECT_THAT(plan.frame_steps, ElementsAre("track.pose"_step, "surface.fit"_step, "surface.refine"_step,
                                            "materials.bake"_step));
}

TEST_F(TakeRun, FramesComeTakeByTake) {
  Project p = house_.newProject();
  p.changeTakes([](const auto&) { return std::vector<Take>{{{0}, {4}, 2}, {{1}, {3}, 2}}; });
  std::vector<int> order;
  for (const Turn& turn : makeRunPlan(p, {}).turns) order.push_back(turn.frame.value);
  EXPECT_THAT(order, ElementsAre(0, 2, 4, 1, 3, 5));
}

TEST_F(TakeRun, ALaterFrameIsGivenTheFrameBeforeAndAFirstOneIsNot) {
  std::map<int, std::string> seen;
  house_.hooks.at_step = [&](const StepId& step, StepContext& c) {
    if (step != "surface.refine"_step) return;
    EXPECT_EQ(c.later(), c.previousResult("surface.refine"_step) != nullptr);
    EXPECT_EQ(c.later(), c.inputs.count("surface.fit"_step) == 0);
    seen[c.frame.value] = c.later() ? c.previousResult("surface.refine"_step)->filename().string() : "";
  };
  RunRequest request = framesOf({0, 1, 2});
  request.until = "surface";
  house_.finish(house_.newProject(), request);
  const Project after = house_.open();
  EXPECT_EQ(seen, (std::map<int, std::string>{{0, ""},
                                              {1, after.key("surface.refine"_step, {0}).hex()},
                                              {2, after.key("surface.refine"_step, {1}).hex()}}));
}

TEST_F(TakeRun, ABrokenOffRunGoesOnToTheSameResults) {
  house_.newProject("whole.beam");
  const RunRequest request{.until = "surface"};
  countsOf(request, "whole.beam");
  house_.newProject();
  house_.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step == "surface.refine"_step && c.frame.value == 3) throw Error(Error::Kind::Storage, "disk full");
  };
  EXPECT_EQ(house_.finish(house_.open(), request).outcome, JobOutcome::Failed);
  house_.hooks.at_step = nullptr;
  EXPECT_EQ(countsOf(request).at("surface.refine"_step), 3);
  EXPECT_EQ(productsOf(house_.root() / "p.beam"), productsOf(house_.root() / "whole.beam"));
}

TEST_F(TakeRun, AFailedFrameEndsItsTakeAndTheNextBeginsAnother) {
  house_.newProject();
  house_.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step == "surface.refine"_step && c.frame.value == 2) throw Error(Error::Kind::Data, "too dark");
  };
  std::string warning;
  double most = 0;
  std::size_t failed = 0;
  for (const JobEvent& event : house_.run(house_.open())) {
    if (const auto* w = std::get_if<JobWarning>(&event)) warning = w->text;
    if (const auto* p = std::get_if<StepProgress>(&event)) most = std::max(most, p->job_fraction);
    if (const auto* f = std::get_if<JobFinished>(&event)) failed = f->failed.size();
  }
  EXPECT_LE(most, 1 + 1e-9);
  EXPECT_EQ(failed, 1u);
  EXPECT_THAT(warning, HasSubstr("frame 003 begins a new take"));
  const SavedTake cut{"003", "005", 1, 0, true};
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "002", 1}, cut));
  EXPECT_EQ(house_.hooks.computed.at("surface.fit"_step), 2);
  EXPECT_EQ(house_.hooks.computed.at("materials.bake"_step), 5);
  EXPECT_EQ(house_.open().state("surface.refine"_step, {2}), StepState::Failed);

  house_.hooks.computed.clear();
  EXPECT_EQ(house_.finish(house_.open()).outcome, JobOutcome::DoneWithFailures);
  EXPECT_EQ(house_.hooks.computed, Counts()) << "it fails again, and the rest stays";
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "002", 1}, cut));

  house_.hooks.at_step = nullptr;
  EXPECT_EQ(countsOf({}),
            (Counts{{"track.pose"_step, 2}, {"surface.refine"_step, 4}, {"materials.bake"_step, 4}}))
      << "what follows builds on it now";
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "005", 1}));
  EXPECT_TRUE(house_.open().earlierTakes().empty());
}

// The take cannot be cut then; no frame is at fault.
TEST_F(TakeRun, EndsWhereProjectJsonIsBrokenMeanwhile) {
  house_.newProject();
  const std::filesystem::path file = house_.root() / "p.beam" / "project.json";
  house_.hooks.at_step = [&](const StepId& step, StepContext& c) {
    if (step != "surface.refine"_step || c.frame.value != 2) return;
    std::ofstream(file) << "{\"garbage";
    throw Error(Error::Kind::Data, "too dark");
  };
  const JobFinished finished = house_.finish(house_.open());
  EXPECT_EQ(finished.outcome, JobOutcome::Failed);
  EXPECT_EQ(finished.kind, Error::Kind::Data);
  EXPECT_THAT(finished.message, HasSubstr("project.json"));
  EXPECT_EQ(finished.failed.size(), 1u);
}

TEST_F(TakeRun, ADamagedResultOfTheFrameBeforeIsComputedAgainAndCutsNothing) {
  house_.newProject();
  house_.finish(house_.open());
  const auto calm = productsOf(house_.root() / "p.beam");
  const Project p = house_.open();
  std::filesystem::remove_all(p.store().folderOf(p.key("track.pose"_step, {3})));
  std::filesystem::remove_all(p.store().folderOf(p.key("surface.refine"_step, {3})));
  const std::filesystem::path before = p.store().folderOf(p.key("surface.refine"_step, {2})) / "data.txt";
  house_.hooks.at_step = [&](const StepId& step, StepContext& c) {
    // The turn of frame 2 is over, that of frame 3 has begun.
    if (step == "track.pose"_step && c.frame.value == 3) std::ofstream(before, std::ios::in) << '!';
  };
  EXPECT_EQ(countsOf({}), (Counts{{"track.pose"_step, 1}, {"surface.refine"_step, 2}}));
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "005", 1}));
  EXPECT_EQ(productsOf(house_.root() / "p.beam"), calm);
}

TEST_F(TakeRun, APictureThatIsGoneOrUnreadableSpoilsNeitherRunNorState) {
  class OddFrames final : public FrameSource {
   public:
    explicit OddFrames(std::string folder) : folder_(std::move(folder)) {}
    bool has(ViewIndex, FrameIndex) const override { return true; }
    std::vector<std::string> files(ViewIndex, FrameIndex frame) const override {
      if (frame.value == 2) return {"gone.png"};
      return frame.value == 4 ? std::vector<std::string>{folder_} : std::vector<std::string>{};
    }
    Image<u8vec3> photo(ViewIndex, FrameIndex frame) const override {
      return Image<u8vec3>(4, 4, u8vec3(static_cast<std::uint8_t>(frame.value)));
    }
    Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return {}; }

   private:
    std::string folder_;
  };
  const auto open = house_.setup->open_capture;
  house_.setup->open_capture = [&](const auto& folder, const auto& options) {
    ImportedCapture imported = open(folder, options);
    imported.set.source = std::make_shared<OddFrames>(house_.root().string());
    return imported;
  };
  house_.newProject();
  EXPECT_EQ(house_.open().state("surface.fit"_step, {0}), StepState::Pending);
  EXPECT_EQ(countsOf({}).at("materials.bake"_step), 6);
  EXPECT_EQ(house_.open().state("materials.bake"_step, {2}), StepState::Done);
  EXPECT_EQ(house_.open().state("materials.bake"_step, {4}), StepState::Done);
}

TEST_F(TakeRun, AFailureThatTheNextFrameDoesNotNeedSplitsNothing) {
  house_.newProject();
  house_.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step == "materials.bake"_step && c.frame.value == 2) throw Error(Error::Kind::Data, "no light");
  };
  EXPECT_EQ(house_.finish(house_.open()).failed.size(), 1u);
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"000", "005", 1}));
}

TEST_F(TakeRun, NamedFramesComputeNothingOutsideOfThem) {
  house_.newProject();
  std::set<int> touched;
  house_.hooks.at_step = [&](const StepId&, StepContext& c) { touched.insert(c.frame.value); };
  countsOf(framesOf({0, 1, 2, 3}));
  touched.clear();
  countsOf(framesOf({2, 3}));
  EXPECT_THAT(touched, ElementsAre(2, 3));
}

TEST_F(TakeRun, ALaterFrameWaitsForTheFrameBeforeThatAnotherProcessIsAt) {
  Project p = house_.newProject();
  arrangeTakes(p, {});
  std::optional<FileLock> other = p.store().tryLease(p.key("surface.refine"_step, {1}));
  ASSERT_TRUE(other);
  int refined_before = -1;
  house_.hooks.at_step = [&](const StepId& step, StepContext& c) {
    if (step != "track.pose"_step || c.frame.value != 5) return;
    refined_before = house_.hooks.computed["surface.refine"_step];
    other.reset();
  };
  EXPECT_EQ(house_.finish(house_.open(), {.until = "surface"}).outcome, JobOutcome::Done);
  EXPECT_EQ(refined_before, 1) << "only the frame before the busy one; poses do not wait";
  EXPECT_EQ(house_.hooks.computed["surface.refine"_step], 6);
  EXPECT_EQ(house_.hooks.computed["surface.fit"_step], 1);
}

TEST_F(TakeRun, ASegmentSolvesItsLeadForItselfAlone) {
  house_.newProject();
  RunRequest request = framesOf({3, 4, 5});
  request.overlap = 2;
  EXPECT_EQ(countsOf(request), (Counts{{"capture.import"_step, 1},
                                       {"track.pose"_step, 5},
                                       {"surface.fit"_step, 1},
                                       {"surface.refine"_step, 5},
                                       {"materials.bake"_step, 3}}))
      << "nothing builds on what is baked";
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"001", "005", 1, 2}));
  EXPECT_EQ(house_.open().state("surface.refine"_step, {2}), StepState::Pending);
  EXPECT_EQ(house_.open().state("surface.refine"_step, {3}), StepState::Done);
  EXPECT_FALSE(house_.open().applies("surface.fit"_step, {3})) << "it is a later frame";

  const Digest seam = house_.open().key("surface.refine"_step, {3});
  EXPECT_EQ(countsOf({}), (Counts{{"track.pose"_step, 3},
                                  {"surface.refine"_step, 3},
                                  {"surface.fit"_step, 1},
                                  {"materials.bake"_step, 3}}))
      << "the frames before make a take of their own";
  EXPECT_EQ(house_.open().key("surface.refine"_step, {3}), seam);
  EXPECT_EQ(countsOf({}), Counts{});
}

TEST_F(TakeRun, AFailedLeadShortensIt) {
  house_.newProject();
  house_.hooks.at_step = [](const StepId& step, StepContext& c) {
    if (step == "surface.refine"_step && c.frame.value == 1) throw Error(Error::Kind::Data, "too dark");
  };
  RunRequest request = framesOf({3, 4, 5});
  request.overlap = 2;
  int told = 0;
  JobFinished finished;
  for (const JobEvent& event : house_.run(house_.open(), request)) {
    if (const auto* failed = std::get_if<StepFailed>(&event)) told += failed->ref.lead;
    if (const auto* end = std::get_if<JobFinished>(&event)) finished = *end;
  }
  EXPECT_EQ(told, 1);
  EXPECT_EQ(finished.outcome, JobOutcome::Done) << "all that was asked for is there";
  EXPECT_THAT(saved(), ElementsAre(SavedTake{"002", "005", 1, 1, false, 1}));
  EXPECT_EQ(house_.hooks.computed.at("materials.bake"_step), 3);
}

TEST_F(TakeRun, AScoutSaysWhereItEnds) {
  house_.newProject();
  RunRequest request;
  request.every = 2;
  EXPECT_THAT(house_.finish(house_.open(), request).notes,
              ElementsAre(HasSubstr("frame 004 is the last that is solved, what follows until 005 is not")));
  request.every = 5;
  EXPECT_THAT(house_.finish(house_.open(), request).notes, ::testing::IsEmpty());
}

TEST_F(TakeRun, TwoRunnersShareATakeWithoutDoingAnythingTwice) {
  house_.newProject();
  std::vector<JobFinished> finished(2);
  {
    std::vector<std::jthread> both;
    for (JobFinished& f : finished) both.emplace_back([&, this] { f = house_.finish(house_.open()); });
  }
  for (const JobFinished& f : finished) EXPECT_EQ(f.outcome, JobOutcome::Done) << f.message;
  EXPECT_EQ(house_.hooks.computed, (Counts{{"capture.import"_step, 1},
                                           {"track.pose"_step, 6},
                                           {"surface.fit"_step, 1},
                                           {"surface.refine"_step, 6},
                                           {"materials.bake"_step, 6}}));
}

TEST_F(TakeRun, TakesOfTwoProcessesAreAllKept) {
  house_.newProject();
  {
    std::vector<std::jthread> threads;
    for (const int first : {0, 3}) {
      threads.emplace_back([&, first] {
        Project p = house_.open();
        for (int length = 1; length < 3; ++length) {
          p.changeTakes([&](std::vector<Take> takes) {
            return addTake(std::move(takes), {{first}, {first + length}, 1});
          });
        }
      });
    }
  }
  EXPECT_THAT(saved(),
              ::testing::UnorderedElementsAre(SavedTake{"000", "002", 1}, SavedTake{"003", "005", 1}));
}

}  // namespace
}  // namespace beam::testing
