// SPDX-License-Identifier: Apache-2.0
// Frames between those of a scout run, over a pipeline whose steps write a stick that turns.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <optional>
#include <set>
#include <utility>

#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/pipeline/disk_use.h"
#include "core/pipeline/take_survey.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/stages/project_sequence.h"
#include "core/stages/render_channels.h"
#include "core/stages/result_files.h"
#include "core/stages/step_ids.h"
#include "core/stages/track_files.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using ::testing::ElementsAre;

constexpr float kTurn = 0.3f;  // radians a frame, about +Y

std::vector<StageInfo> stages() {
  return {{"track",
           "Track",
           "",
           {{.id = "joints",
             .title = "Joints",
             .reads = {Reads::Pictures},
             .frames = Frames::InTakes,
             .later = {.previous = {kJointsStep}}}}},
          {"surface",
           "Surface",
           "",
           {{.id = "fit",
             .title = "Fit",
             .reads = {Reads::Pictures},
             .later = {.inputs = {kJointsStep}, .previous = {kFitStep}},
             .shown = {.frame = true}},
            {.id = "refine",
             .title = "Refine",
             .inputs = {kFitStep},
             .later = {.inputs = {kJointsStep}, .previous = {kRefineStep}},
             .shown = {.frame = true, .surface = kRefineStep}}}},
          {"materials",
           "Materials",
           "",
           {{.id = "fit",
             .title = "Fit",
             .inputs = {kRefineStep},
             .later = {.previous = {kMaterialsStep}},
             .shown = {.frame = true, .surface = kRefineStep}}}}};
}

GaussianCloud stickAt(float frame) {
  const quat turn = glm::angleAxis(kTurn * frame, vec3(0, 1, 0));
  GaussianCloud cloud;
  for (int i = 0; i < 12; ++i) {
    cloud.position_m.push_back(turn *
                               vec3(0.1f * static_cast<float>(i), 0.01f * static_cast<float>(i % 3), 0));
    cloud.rotation.push_back(turn);
  }
  cloud.scale_m.assign(12, vec3(0.02f));
  cloud.opacity.assign(12, 0.9f);
  cloud.color = ShBlock(12, 3);
  return cloud;
}

// Frames 0 3 6 solved of eight.
class Scout {
 public:
  explicit Scout(std::set<int> restarts = {}) : restarts_(std::move(restarts)), house_(stages()) {
    house_.frame_names = {"000", "001", "002", "003", "004", "005", "006", "007"};
    house_.hooks.at_step = [this](const StepId& step, StepContext& c) { write(step, c); };
    project_.emplace(house_.newProject());
    RunRequest request;
    request.every = 3;
    EXPECT_TRUE(house_.finish(*project_, request).failed.empty());
    project_->readTakesAgain();
  }

  Project project() const { return *project_; }
  Project reopened() { return house_.open(); }
  // A run over all frames that stops in the joints of `stop_at`; -1: it does not.
  void solveAll(int stop_at) {
    house_.hooks.at_step = [this, stop_at](const StepId& step, StepContext& c) {
      if (step == kJointsStep && c.frame.value == stop_at) throw Cancelled();
      write(step, c);
    };
    house_.finish(*project_);
    project_->readTakesAgain();
  }
  std::filesystem::path folder() const { return house_.root(); }

 private:
  void write(const StepId& step, StepContext& c) const {
    const auto f = static_cast<float>(c.frame.value);
    if (step == kJointsStep) {
      writeSplatPly(c.folder / kJointsFile, stickAt(f), nullptr);
      writePosePly(c.folder / kRestPoseFile, poseOf(stickAt(0)));
      writeTrackNote(c.folder, {restarts_.contains(c.frame.value), 1});
      return;
    }
    Materials materials{std::vector<float>(12, 0.1f + 0.1f * f), ShBlock(12, 3), ShBlock(12, 1)};
    if (step == kMaterialsStep) return writeSplatPly(c.folder / kMaterialsFile, stickAt(f), &materials);
    writeSplatPly(c.folder / kCloudFile, stickAt(f), nullptr);
    if (!c.later() || restarts_.contains(c.frame.value)) return;
    writePosePly(c.folder / kRestPoseFile, poseOf(stickAt(0)));
    writePosePly(c.folder / kJointPoseFile, poseOf(stickAt(f)));
  }

  std::set<int> restarts_;
  FakeHouse house_;
  std::optional<Project> project_;
};

// Solved once for all tests.
const Scout& solved() {
  static const Scout scout;
  return scout;
}

TEST(InterpolatedFrame, ShowsWhatLiesBetweenItsFrames) {
  const Project project = solved().project();
  for (const int f : {1, 2, 4, 5}) {
    EXPECT_FALSE(sequenceOf(project, Shows::Solved)->load({f})) << "nothing is kept of it";
    const auto sequence = sequenceOf(project, Shows::Between);
    const auto shown = sequence->load({f});
    ASSERT_TRUE(shown) << f;
    EXPECT_TRUE(shown->interpolated);
    EXPECT_TRUE(shown->refined);
    const GaussianCloud expected = stickAt(static_cast<float>(f));
    for (std::size_t i = 0; i < 12; ++i)
      EXPECT_LT(glm::length(shown->cloud.position_m[i] - expected.position_m[i]), 1e-5f) << f << " " << i;
    ASSERT_TRUE(shown->materials);
    EXPECT_NEAR(shown->materials->roughness[5], 0.1f + 0.1f * static_cast<float>(f), 1e-5);
    EXPECT_TRUE(sequence->content({f}).interpolated);
    EXPECT_EQ(sequence->before({f}), FrameIndex{f < 3 ? 0 : 3});
  }
}

TEST(InterpolatedFrame, HasJointsBetweenThoseOfItsNeighbours) {
  const Project project = solved().project();
  const auto sequence = sequenceOf(project, Shows::Between);
  const FrameJoints joints = sequence->joints({4});
  ASSERT_EQ(joints.pose.size(), 12u);
  EXPECT_TRUE(joints.interpolated);
  const GaussianCloud expected = stickAt(4);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_LT(glm::length(joints.pose.position_m[i] - expected.position_m[i]), 1e-5f) << i;
  EXPECT_EQ(sequence->joints({7}).pose.size(), 0u) << "behind the last";
  EXPECT_EQ(sequenceOf(Scout({6}).project(), Shows::Between)->joints({4}).pose.size(), 0u) << "others";
}

TEST(InterpolatedFrame, LeavesItsOwnFramesAloneAndHasNothingBehindTheLast) {
  const Project project = solved().project();
  const auto sequence = sequenceOf(project, Shows::Between);
  EXPECT_FALSE(sequence->load({3})->interpolated);
  EXPECT_FALSE(sequence->content({3}).interpolated);
  EXPECT_FALSE(sequence->load({7}));
  EXPECT_FALSE(sequence->content({7}).gaussians);
}

TEST(InterpolatedFrame, HasNothingWhereTheJointsStartedAnew) {
  const Scout scout({6});
  const auto sequence = sequenceOf(scout.project(), Shows::Between);
  EXPECT_TRUE(sequence->load({2}));
  EXPECT_FALSE(sequence->load({4}));
  EXPECT_FALSE(sequence->content({4}).gaussians);
}

TEST(ProjectSequence, TellsOfATakeWhatItsFramesHangOn) {
  const auto sequence = sequenceOf(solved().project(), Shows::Solved);
  const auto take = sequence->take({6});
  ASSERT_TRUE(take);
  EXPECT_EQ(take->first, FrameIndex{0});
  EXPECT_TRUE(take->restarts.empty());
  EXPECT_EQ(take->rest_joints.position_m, poseOf(stickAt(0)).position_m);
  EXPECT_EQ(take->binding.points(), 12u);
  EXPECT_EQ(sequence->before({6}), FrameIndex{3});
  EXPECT_EQ(sequence->before({0}), std::nullopt);
  const auto carried = sequence->carried({6});
  ASSERT_TRUE(carried);
  EXPECT_EQ(carried->rest_skin.position_m, poseOf(stickAt(0)).position_m) << "its own, on the joints at rest";
  EXPECT_EQ(carried->joints.position_m, poseOf(stickAt(6)).position_m);
  EXPECT_FALSE(sequence->take({7})) << "in no take";
  const auto anew = sequenceOf(Scout({6}).project(), Shows::Solved)->take({3});
  EXPECT_EQ(anew->restarts, std::vector<FrameIndex>{FrameIndex{6}});
}

TEST(ProjectSequence, AnswersSeveralThreadsAtOnceAndAlike) {
  const auto sequence = sequenceOf(solved().project(), Shows::Between);
  const auto all = [&] {
    std::vector<vec3> positions;
    for (int f = 0; f < 7; ++f) {
      EXPECT_TRUE(sequence->content({f}).materials);
      EXPECT_NE(sequence->stamp({f}), Digest{});
      const auto frame = sequence->load({f});
      positions.insert(positions.end(), frame->cloud.position_m.begin(), frame->cloud.position_m.end());
    }
    return positions;
  };
  const std::vector<vec3> alone = all();
  std::vector<std::future<std::vector<vec3>>> together;
  for (int i = 0; i < 4; ++i) together.push_back(std::async(std::launch::async, all));
  for (auto& found : together) EXPECT_TRUE(found.get() == alone);
}

TEST(InterpolatedFrame, OfAScoutIsShownUntilAFullRunIsAsFar) {
  Scout scout;
  scout.solveAll(2);
  const Project project = scout.project();
  ASSERT_EQ(project.earlierTakes(), (std::vector<Take>{{{0}, {6}, 3}}));
  const auto sequence = sequenceOf(project, Shows::Between);
  for (int f = 0; f < 7; ++f) {
    const auto shown = sequence->load({f});
    ASSERT_TRUE(shown) << f;
    EXPECT_EQ(shown->interpolated, f == 2 || f == 4 || f == 5) << f;
    EXPECT_TRUE(shown->materials) << f;
    EXPECT_EQ(sequence->content({f}).interpolated, shown->interpolated) << f;
    EXPECT_NE(sequence->stamp({f}), Digest{}) << f;
    const GaussianCloud expected = stickAt(static_cast<float>(f));
    EXPECT_LT(glm::length(shown->cloud.position_m[7] - expected.position_m[7]), 1e-5f) << f;
  }
  EXPECT_TRUE(sequence->joints({5}).interpolated);
  EXPECT_EQ(sequence->before({5}), FrameIndex{3});
  TakeSurveyor surveyor;
  const TakeSurvey survey = surveyor.survey(project);
  EXPECT_EQ(survey.lanes[1].cells[1], CellState::Done);
  EXPECT_EQ(survey.lanes[1].cells[4], CellState::Interpolated);
  EXPECT_NE(survey.stamps[4], Digest{});
  Progress progress;
  EXPECT_EQ(diskUse(project, progress).others().count, 0) << "a clean leaves what is shown";

  // Settings change, and a run with them ends: they may change back.
  Project changed = project;
  changed.set("surface.iterations", 7);
  changed.dropOutdoneTakes(progress);
  EXPECT_EQ(scout.reopened().earlierTakes(), project.earlierTakes());

  scout.solveAll(-1);
  EXPECT_TRUE(scout.project().earlierTakes().empty());
  EXPECT_FALSE(sequenceOf(scout.project(), Shows::Between)->load({4})->interpolated);
  EXPECT_GT(diskUse(scout.project(), progress).others().count, 0);
}

TEST(InterpolatedFrame, IsRenderedOnlyWhereThatIsAskedFor) {
  const Project project = solved().project();
  const auto device = makeCpuDevice();
  const auto renderer = newCpuSceneRenderer(*device);
  RenderRequest request;
  request.channels = {"rgb"};
  request.frames = {FrameIndex{1}};
  request.out = solved().folder() / "out";
  Progress progress;
  EXPECT_THROW(renderChannels(*sequenceOf(project, Shows::Solved), request, *renderer, progress), Error);
  EXPECT_NO_THROW(renderChannels(*sequenceOf(project, Shows::Between), request, *renderer, progress));
}

TEST(InterpolatedFrame, IsDrawnAsSuchAndReadAgainWithItsNeighbours) {
  Project project = solved().project();
  TakeSurveyor surveyor;
  const TakeSurvey survey = surveyor.survey(project);
  const CellState done = CellState::Done, between = CellState::Interpolated;
  const CellState none = CellState::NotNeeded, to_do = CellState::Empty;
  for (const std::size_t lane : {0, 1, 2}) {
    EXPECT_THAT(survey.lanes[lane].cells,
                ElementsAre(done, between, between, done, between, between, done, lane == 0 ? none : to_do));
  }
  EXPECT_NE(survey.stamps[1], Digest{});
  EXPECT_NE(survey.stamps[1], survey.stamps[4]);
  EXPECT_EQ(survey.stamps[7], Digest{});
  project.set("materials.iterations", 11);
  const TakeSurvey changed = surveyor.survey(project);
  EXPECT_NE(changed.stamps[1], survey.stamps[1]);
  EXPECT_EQ(changed.lanes[1].cells[1], between);
  EXPECT_EQ(changed.lanes[2].cells[1], CellState::Empty);
}

}  // namespace
}  // namespace beam::testing
