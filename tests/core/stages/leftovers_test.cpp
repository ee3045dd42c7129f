// SPDX-License-Identifier: Apache-2.0
// What is shown of a frame after settings changed: a pipeline whose steps write one Gaussian, whose place
// tells which step made it with which number of iterations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <optional>

#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/pipeline/take_survey.h"
#include "core/stages/project_sequence.h"
#include "core/stages/result_files.h"
#include "core/stages/step_ids.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;

std::vector<StageInfo> stages() {
  return {{"surface",
           "Surface",
           "",
           {{.id = "fit", .title = "Fit", .reads = {Reads::Pictures}, .shown = {.frame = true}},
            {.id = "refine",
             .title = "Refine",
             .inputs = {kFitStep},
             .shown = {.frame = true, .surface = kRefineStep}},
            {.id = "mesh",
             .title = "Mesh",
             .inputs = {kRefineStep},
             .shown = {.frame = true, .surface = kRefineStep}}}},
          {"materials",
           "Materials",
           "",
           {{.id = "fit",
             .title = "Fit",
             .inputs = {kRefineStep},
             .shown = {.frame = true, .surface = kRefineStep, .last = true}}}}};
}

// One project of which every run writes clouds at `x_m = mark`, in order.
class Marked {
 public:
  Marked() : house_(stages()) {
    house_.hooks.at_step = [this](const StepId& step, StepContext& c) { write(step, c); };
    project_.emplace(house_.newProject());
  }

  // With this many iterations in `stage`, as far as `until`.
  void run(float mark, const std::string& until = {}) {
    mark_ = mark;
    EXPECT_EQ(house_.finish(*project_, {{FrameIndex{0}}, "", until}).outcome, JobOutcome::Done);
    project_->readTakesAgain();
    age();
  }
  Project& project() { return *project_; }
  FakeHouse& house() { return house_; }
  std::shared_ptr<const GaussianFrame> shown() { return newest(*project_)->load(FrameIndex{0}); }
  std::shared_ptr<const Mesh> mesh() { return newest(*project_)->mesh(FrameIndex{0}); }
  static std::shared_ptr<const GaussianSequence> newest(const Project& project) {
    return sequenceOf(project, Shows::Newest,
                      std::make_shared<const TakeSurvey>(TakeSurveyor().survey(project)));
  }

 private:
  void write(const StepId& step, StepContext& c) const {
    GaussianCloud cloud;
    cloud.position_m.emplace_back(mark_, 0, 0);
    cloud.rotation.assign(1, quat(1, 0, 0, 0));
    cloud.scale_m.assign(1, vec3(0.02f));
    cloud.opacity.assign(1, 0.9f);
    cloud.color = ShBlock(1, 3);
    if (step == kMeshStep) {
      Mesh mesh;
      for (const float y : {0.0f, 1.0f}) mesh.vertices.emplace_back(mark_, y, 0);
      mesh.vertices.emplace_back(mark_, 0, 1);
      mesh.triangles.push_back({0u, 1u, 2u});
      return writeMeshPly(c.folder / kMeshFile, mesh);
    }
    const Materials materials{std::vector<float>(1, 0.4f), ShBlock(1, 3), ShBlock(1, 1)};
    const bool fit = step == kMaterialsStep;
    writeSplatPly(c.folder / (fit ? kMaterialsFile : kCloudFile), cloud, fit ? &materials : nullptr);
  }
  // What is there is a minute older than what comes.
  void age() const {
    for (const Digest& key : project_->store().keys()) {
      const auto file = project_->store().folderOf(key) / "result.json";
      std::filesystem::last_write_time(file,
                                       std::filesystem::last_write_time(file) - std::chrono::minutes(1));
    }
  }

  FakeHouse house_;
  std::optional<Project> project_;
  float mark_ = 0;
};

float markOf(const std::shared_ptr<const GaussianFrame>& result) {
  return result && result->cloud.size() == 1 ? result->cloud.position_m[0].x : -1;
}

TEST(Leftovers, WhatIsInForceIsShownAndIsNotStale) {
  Marked marked;
  EXPECT_FALSE(marked.shown());
  marked.run(1);
  EXPECT_EQ(markOf(marked.shown()), 1);
  EXPECT_FALSE(marked.shown()->stale);
  EXPECT_TRUE(marked.shown()->stale_note.empty());
}

TEST(Leftovers, MaterialsOfOtherSettingsStayOnTheSurfaceInForce) {
  Marked marked;
  marked.run(1);
  marked.project().set("materials.iterations", 11);
  marked.run(2);
  marked.project().set("materials.iterations", 12);
  const auto shown = marked.shown();
  EXPECT_EQ(markOf(shown), 2) << "the newest";
  ASSERT_TRUE(shown->materials);
  EXPECT_TRUE(shown->stale);
  EXPECT_THAT(shown->stale_note, HasSubstr("materials"));
  ASSERT_TRUE(marked.mesh());
  EXPECT_EQ(marked.mesh()->vertices[0].x, 1) << "of the surface in force";
  const auto exported = sequenceOf(marked.project(), Shows::Between)->load(FrameIndex{0});
  EXPECT_EQ(markOf(exported), 1) << "nothing of old to export";
  EXPECT_FALSE(exported->materials);
}

TEST(Leftovers, ASurfaceInForceComesBeforeMaterialsOfAnotherSurface) {
  Marked marked;
  marked.run(1);
  marked.project().set("surface.iterations", 11);
  marked.run(2, "surface");
  const auto shown = marked.shown();
  EXPECT_EQ(markOf(shown), 2);
  EXPECT_FALSE(shown->materials);
  EXPECT_FALSE(shown->stale);
  EXPECT_EQ(marked.mesh()->vertices[0].x, 2);
}

TEST(Leftovers, WithNothingInForceTheNewestMaterialsAreShownWithTheirMesh) {
  Marked marked;
  marked.run(1);
  marked.project().set("surface.iterations", 11);
  marked.run(2);
  marked.project().set("surface.iterations", 12);
  marked.run(3, "surface");
  marked.project().set("surface.iterations", 13);
  const auto shown = marked.shown();
  EXPECT_EQ(markOf(shown), 2) << "materials before a newer surface without";
  EXPECT_TRUE(shown->stale);
  EXPECT_TRUE(shown->refined);
  ASSERT_TRUE(marked.mesh());
  EXPECT_EQ(marked.mesh()->vertices[0].x, 2);
  EXPECT_FALSE(sequenceOf(marked.project(), Shows::Between)->load(FrameIndex{0}));
}

TEST(Leftovers, DamagedOnesArePassedOver) {
  Marked marked;
  marked.run(1);
  marked.project().set("surface.iterations", 11);
  marked.run(2);
  std::ofstream(*marked.project().result(kMaterialsStep, FrameIndex{0}) / kMaterialsFile,
                std::ios::in | std::ios::out)
      << "?";
  marked.project().set("surface.iterations", 12);
  EXPECT_EQ(markOf(marked.shown()), 1);
}

TEST(Leftovers, OfASurfaceWithoutMaterialsAreShownToo) {
  Marked marked;
  marked.run(1, "surface");
  marked.project().set("surface.iterations", 11);
  const auto shown = marked.shown();
  EXPECT_EQ(markOf(shown), 1);
  EXPECT_TRUE(shown->stale);
  EXPECT_FALSE(shown->materials);
}

TEST(Leftovers, ChangeTheStampOfAFrameUntilItHasMaterialsInForce) {
  Marked marked;
  TakeSurveyor surveyor;
  marked.run(1);
  const Digest done = surveyor.survey(marked.project()).stamps[0];
  marked.project().set("surface.iterations", 11);
  const Digest stale = surveyor.survey(marked.project()).stamps[0];
  EXPECT_NE(stale, done);
  EXPECT_NE(stale, Digest{}) << "there is something to show";
  marked.project().reset("surface.iterations");
  EXPECT_EQ(surveyor.survey(marked.project()).stamps[0], done);
}

TEST(Leftovers, OfAProjectWithoutItsCaptureAreAllThereIs) {
  Marked marked;
  marked.run(1);
  std::filesystem::rename(marked.house().root() / "capture", marked.house().root() / "elsewhere");
  Project lost = marked.house().open();
  lost.lookWithoutCapture();
  const TakeSurvey survey = TakeSurveyor().survey(lost);
  ASSERT_EQ(survey.frames, std::vector<std::string>{"000"});
  EXPECT_NE(survey.stamps[0], Digest{});
  const auto sequence = sequenceOf(lost, Shows::Newest, std::make_shared<const TakeSurvey>(survey));
  EXPECT_TRUE(sequence->content(FrameIndex{0}).materials);
  const auto shown = sequence->load(FrameIndex{0});
  EXPECT_EQ(markOf(shown), 1);
  EXPECT_TRUE(shown->stale);
  EXPECT_TRUE(shown->materials);
  EXPECT_TRUE(sequence->mesh(FrameIndex{0}));
}

}  // namespace
}  // namespace beam::testing
