// SPDX-License-Identifier: Apache-2.0
// What of a take enters keys, and what does not.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/pipeline/take_survey.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class TakeKeys : public ::testing::Test {
 protected:
  TakeKeys() {
    house_.frame_names.clear();
    for (int i = 0; i < 12; ++i) house_.frame_names.push_back(fmt::format("{:03}", i));
  }
  Project with(std::vector<Take> takes) {
    Project project = house_.newProject(fmt::format("p{}.beam", ++projects_));
    project.changeTakes([&](const auto&) { return takes; });
    return project;
  }
  static std::vector<std::string> upstreamOf(const Project& p, const StepId& step, int frame) {
    std::vector<std::string> names;
    for (const auto& [name, key] : namedResults(p.ingredients(step, {frame}))) names.push_back(name);
    return names;
  }
  FakeHouse house_{fakeStagesWithTakes()};
  int projects_ = 0;
};

TEST_F(TakeKeys, TheFirstFrameHasTheKeysOfALoneOne) {
  const Project lone = with({}), take = with({{{4}, {9}, 1}});
  for (const StepId& step : {"surface.fit"_step, "surface.refine"_step, "materials.bake"_step})
    EXPECT_EQ(take.key(step, {4}), lone.key(step, {4})) << step;
  EXPECT_NE(take.key("surface.refine"_step, {5}), lone.key("surface.refine"_step, {5}));
}

TEST_F(TakeKeys, ALaterFrameReadsWhatTheStepSaysOfItsOwnFrameAndOfTheOneBefore) {
  const Project p = with({{{0}, {5}, 1}});
  EXPECT_THAT(upstreamOf(p, "surface.refine"_step, 0), ElementsAre("surface.fit"));
  EXPECT_THAT(upstreamOf(p, "surface.refine"_step, 3), ElementsAre("previous surface.refine", "track.pose"));
  EXPECT_THAT(upstreamOf(p, "track.pose"_step, 1), ElementsAre("capture.import", "previous track.pose"));
  EXPECT_EQ(p.ingredients("surface.refine"_step, {3}).previous.at("surface.refine"_step),
            p.key("surface.refine"_step, {2}));
}

TEST_F(TakeKeys, StepsAreForTheFramesTheySay) {
  const Project p = with({{{0}, {5}, 1}});
  EXPECT_TRUE(p.applies("surface.fit"_step, {0}));
  EXPECT_FALSE(p.applies("surface.fit"_step, {1}));
  EXPECT_TRUE(p.applies("surface.fit"_step, {7}));
  EXPECT_TRUE(p.applies("track.pose"_step, {0}));
  EXPECT_FALSE(p.applies("track.pose"_step, {7}));
  EXPECT_EQ(p.state("track.pose"_step, {7}), StepState::NotNeeded);
  EXPECT_EQ(p.stageState("track", {7}), StepState::Done);
  EXPECT_EQ(p.stageState("surface", {1}), StepState::Pending);
  EXPECT_FALSE(p.result("surface.fit"_step, {1}));
  EXPECT_THROW(p.key("surface.fit"_step, {1}), Error);
}

TEST_F(TakeKeys, APictureVoidsItsFrameAndTheLaterOnesOfItsTake) {
  const Project p = with({{{0}, {3}, 1}, {{4}, {9}, 1}});
  std::vector<Digest> before;
  for (int f = 0; f < 12; ++f) before.push_back(p.key("materials.bake"_step, {f}));
  house_.frames->changed[{0, 2}] = 200;
  p.forgetKeys();
  for (int f = 0; f < 12; ++f)
    EXPECT_EQ(p.key("materials.bake"_step, {f}) != before[static_cast<std::size_t>(f)], f == 2 || f == 3)
        << f;
}

TEST_F(TakeKeys, FieldsOfTheGroupLaterVoidLaterFramesOnly) {
  Project p = with({{{0}, {2}, 1}});
  const Digest first = p.key("materials.bake"_step, {0}), later = p.key("surface.refine"_step, {1}),
               lone = p.key("surface.refine"_step, {5});
  p.set("surface.later.reach", 2.0);
  EXPECT_EQ(p.key("materials.bake"_step, {0}), first);
  EXPECT_EQ(p.key("surface.refine"_step, {5}), lone);
  EXPECT_NE(p.key("surface.refine"_step, {1}), later);
  p.reset("surface.later.reach");
  EXPECT_EQ(p.key("surface.refine"_step, {1}), later);
}

TEST_F(TakeKeys, TheEndOfATakeEntersNoKeyAndItsStrideOnlyByTheFrameBefore) {
  const Project shorter = with({{{0}, {4}, 1}}), longer = with({{{0}, {9}, 1}}),
                scout = with({{{0}, {8}, 4}});
  for (const StepId& step : {"track.pose"_step, "surface.refine"_step}) {
    EXPECT_EQ(shorter.key(step, {4}), longer.key(step, {4})) << step;
    EXPECT_NE(scout.key(step, {4}), longer.key(step, {4})) << step;
    EXPECT_EQ(scout.key(step, {0}), longer.key(step, {0})) << step;
  }
}

TEST_F(TakeKeys, AFrameBehindALaterTakeKeepsItsOwnChain) {
  const Project whole = with({{{0}, {9}, 1}}), other = with({{{0}, {9}, 1}, {{4}, {5}, 1}});
  EXPECT_EQ(other.key("surface.refine"_step, {6}), whole.key("surface.refine"_step, {6}));
  EXPECT_NE(other.key("surface.refine"_step, {5}), whole.key("surface.refine"_step, {5}));
}

TEST_F(TakeKeys, ALaterResultThatReadsNothingMoreStillIsALaterOne) {
  KeyIngredients first{"s.t"_step, 1, {}, {}, {}}, later = first;
  later.later = true;
  EXPECT_NE(keyOf(first), keyOf(later));
}

TEST_F(TakeKeys, AnUnknownTakeOfFramesLeftOutOfTheCaptureIsPassedOver) {
  Project p = with({{{0}, {9}, 1}});
  house_.frame_names.resize(5);
  const Project shortened = house_.open(p.folder().filename().string());
  EXPECT_THAT(shortened.takes(), IsEmpty());
  EXPECT_TRUE(shortened.applies("surface.fit"_step, {3}));
}

// As many steps as frames, not the square or worse of it; and no deep recursion.
TEST_F(TakeKeys, ALongTakeCostsEachFrameOnce) {
  class CountingFrames final : public FrameSource {
   public:
    mutable int photos = 0;
    bool has(ViewIndex view, FrameIndex) const override { return view.value == 0; }
    Image<u8vec3> photo(ViewIndex, FrameIndex frame) const override {
      ++photos;
      return Image<u8vec3>(1, 1, u8vec3(static_cast<std::uint8_t>(frame.value), frame.value >> 8, 0));
    }
    Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return {}; }
  };
  constexpr int kFrames = 2000;
  const auto counting = std::make_shared<CountingFrames>();
  house_.frame_names.clear();
  for (int i = 0; i < kFrames; ++i) house_.frame_names.push_back(fmt::format("{:04}", i));
  const auto open = house_.setup->open_capture;
  house_.setup->open_capture = [&](const auto& folder, const auto& options) {
    ImportedCapture imported = open(folder, options);
    imported.set.source = counting;
    return imported;
  };
  const Project p = with({{{0}, {kFrames - 1}, 1}});
  p.key("materials.bake"_step, {kFrames - 1});
  const int chain = counting->photos;
  EXPECT_LE(chain, 2 * kFrames + 2) << "pose and refine look at the pictures of each frame";
  for (int f = 0; f < kFrames; ++f) p.key("surface.refine"_step, {f});
  EXPECT_LE(counting->photos, chain + 2 * kFrames) << "then each key looks at its own only";
  TakeSurveyor surveyor;
  const int before_survey = counting->photos;
  surveyor.survey(p);
  const int surveyed = counting->photos - before_survey;
  EXPECT_LE(surveyed, 2 * kFrames + 2);
  surveyor.survey(p);
  EXPECT_EQ(counting->photos, before_survey + surveyed) << "known keys are not worked out again";
}

}  // namespace
}  // namespace beam::testing
