// SPDX-License-Identifier: Apache-2.0
#include "core/scene/render_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>

#include "core/base/error.h"
#include "tests/support/random_look.h"

namespace beam {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Keeps its frames, so that the same frame is the same data.
class StandingSequence final : public GaussianSequence {
 public:
  explicit StandingSequence(int frames, double rate = 30) : rate_(rate) {
    std::vector<std::string> names;
    for (int i = 0; i < frames; ++i) {
      names.push_back("frame_" + std::to_string(10 + i));
      auto frame = std::make_shared<GaussianFrame>();
      frame->cloud.position_m.assign(static_cast<std::size_t>(i), vec3(0));
      frame->attributes.push_back({{.name = "metallic"}, {}});
      loaded[i] = frame;
    }
    labels_ = labelled(names);
  }
  std::string id() const override { return "standing"; }
  const std::vector<FrameLabel>& frames() const override { return labels_; }
  double rate() const override { return rate_; }
  std::optional<Digest> stamp(FrameIndex) const override { return Digest{}; }
  FrameContent content(FrameIndex) const override { return {}; }
  std::shared_ptr<const GaussianFrame> load(FrameIndex frame) const override {
    return loaded.at(frame.value);
  }
  RenderMode renderMode() const override { return {0.3f}; }

  std::map<int, std::shared_ptr<GaussianFrame>> loaded;

 private:
  std::vector<FrameLabel> labels_;
  double rate_;
};

// One performance, one mesh, an environment; everything is there.
struct Stage {
  Stage() {
    document.performances = {{.project = {"", "/p.beam"}, .scene_from_performance = {.scale = 2}}};
    document.meshes = {{.file = {"", "/chair.ply"}, .base_color = dvec3(0.2, 0.4, 0.8)}};
    document.look.lighting.lights = {newLight("key", "spot"), newLight("hole", "portal")};
    document.look.curves["lights.key.intensity"] = {{{0, 0}, {1, 8}}};
    open.sequence = [this](const Performance&) { return sequence; };
    open.mesh = [this](const SceneMesh&) { return OpenedMesh{mesh}; };
    open.environment = [this](const EnvironmentLight&) { return environment; };
  }
  RenderScene at(double time_s) const { return sceneAt(document, time_s, open); }

  std::shared_ptr<StandingSequence> sequence = std::make_shared<StandingSequence>(10);
  std::shared_ptr<const Mesh> mesh = std::make_shared<Mesh>();
  std::shared_ptr<const Environment> environment = std::make_shared<Environment>();
  SceneDocument document;
  SceneSources open;
};

TEST(Scene, AtATimeHasWhatTheDocumentNamesWithTheValuesOfThatTime) {
  const Stage stage;
  const RenderScene scene = stage.at(0.5);
  ASSERT_EQ(scene.instances.size(), 1u);
  const RenderInstance& one = scene.instances[0];
  EXPECT_EQ(one.cloud->size(), 9u) << "frame 15 of 30 a second; the last is held";
  EXPECT_EQ(one.cloud.get(), &stage.sequence->loaded.at(9)->cloud) << "no copies";
  EXPECT_EQ(one.attributes.get(), &stage.sequence->loaded.at(9)->attributes);
  EXPECT_FALSE(one.materials);
  EXPECT_EQ(one.world_from_cloud.scale, 2);
  EXPECT_EQ(one.mode, RenderMode{0.3f});
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].mesh, stage.mesh);
  EXPECT_EQ(scene.meshes[0].base_color, vec3(0.2f, 0.4f, 0.8f));
  EXPECT_EQ(scene.environment, stage.environment);
  EXPECT_EQ(std::get<SpotLight>(scene.lighting.lights[0].kind).intensity, 4);
  EXPECT_EQ(scene.lighting.lights.size(), 2u) << "one that nobody draws stays in the list";
  EXPECT_THAT(scene.missing, IsEmpty());
}

TEST(Scene, IsTheSameWhileNothingOfItChanges) {
  Stage stage;
  stage.document.look.curves.clear();
  const RenderScene before = stage.at(0.1);
  EXPECT_EQ(stage.at(0.1), before);
  EXPECT_EQ(stage.at(0.11), before) << "the same frame";
  EXPECT_NE(stage.at(0.2), before);
  EXPECT_EQ(stage.at(0.2).meshes, before.meshes);
  stage.document.performances[0].scene_from_performance.translation.x = 1;
  EXPECT_NE(stage.at(0.1).instances[0], before.instances[0]);
  EXPECT_EQ(stage.at(0.1).lighting, before.lighting);
}

TEST(Scene, KeepsTheDataOfAFrameAliveByItself) {
  Stage stage;
  const RenderScene scene = stage.at(0);
  const std::weak_ptr<GaussianFrame> frame = stage.sequence->loaded.at(0);
  stage.sequence->loaded.clear();
  EXPECT_FALSE(frame.expired());
  EXPECT_EQ(scene.instances[0].attributes->front().info.name, "metallic");
}

TEST(Scene, NamesWhatIsMissingAndHasTheRest) {
  Stage stage;
  stage.sequence->loaded[2] = nullptr;
  stage.document.performances.push_back({.project = {"", "/gone.beam"}});
  stage.document.performances.push_back({.project = {"", "/short.beam"}, .frames = "10-99"});
  stage.document.performances.push_back({.project = {"", "/whole.beam"}, .time_offset_s = 2});
  stage.open.sequence = [&](const Performance& p) -> std::shared_ptr<const GaussianSequence> {
    if (p.project.absolute == "/gone.beam") throw Error(Error::Kind::Data, "no such folder");
    return stage.sequence;
  };
  stage.open.mesh = [](const SceneMesh&) { return OpenedMesh{}; };
  stage.document.look.lighting.environment.file = {"", "/sky.exr"};
  stage.environment = nullptr;
  const RenderScene scene = stage.at(2 / 30.0);
  EXPECT_THAT(scene.missing,
              ElementsAre(AllOf(HasSubstr("/p.beam"), HasSubstr("frame frame_12 has no Gaussians")),
                          AllOf(HasSubstr("/gone.beam"), HasSubstr("no such folder")),
                          AllOf(HasSubstr("/short.beam"), HasSubstr("10-99")), HasSubstr("/chair.ply"),
                          HasSubstr("/sky.exr")));
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].cloud->size(), 0u) << "the one that has not begun yet shows its first frame";
  stage.document.look.lighting.environment.enabled = false;
  EXPECT_THAT(stage.at(2 / 30.0).missing, ::testing::Not(::testing::Contains(HasSubstr("sky"))));
  EXPECT_EQ(sceneAt(stage.document, 0, {}).missing.size(), 5u) << "sources that are not set have nothing";
}

TEST(Scene, ABrokenPromiseIsNotSomethingThatIsMissing) {
  Stage stage;
  stage.open.mesh = [](const SceneMesh&) -> OpenedMesh { throw Error(Error::Kind::Bug, "ours"); };
  EXPECT_THROW(stage.at(0), Error);
}

// --- Time ---

TEST(Performances, ShowEachFrameAtItsOwnTimeForEveryRate) {
  for (const double rate : {23.976, 24.0, 25.0, 29.97, 30.0, 49.0, 50.0, 59.94, 60.0, 120.0}) {
    const StandingSequence sequence(400, rate);
    for (int i = 0; i < 400; ++i) EXPECT_EQ(frameAt({}, sequence, i / rate).value, i) << rate;
    EXPECT_EQ(frameAt({}, sequence, 6.999 / rate).value, 6);
  }
}

TEST(Performances, StartAtTheirOffsetGoAtTheirSpeedAndHoldAtTheirEnds) {
  const StandingSequence sequence(10, 10);
  const Performance p{.frames = "12-16", .time_offset_s = 5, .speed = 2};  // positions 2 to 6
  const std::vector<std::pair<double, int>> expected = {{-100, 2}, {5, 2},   {5.04, 2}, {5.06, 3},
                                                        {5.1, 4},  {5.2, 6}, {5.3, 6},  {1e9, 6}};
  for (const auto& [time_s, frame] : expected) EXPECT_EQ(frameAt(p, sequence, time_s).value, frame) << time_s;
  EXPECT_EQ(frameAt({.speed = 0}, sequence, 77).value, 0);
}

TEST(Performances, OfEveryOtherFrameKeepTheirPace) {
  const StandingSequence sequence(10, 10);
  const Performance p{.frames = "11-19x3"};  // positions 1, 4, 7
  const std::vector<int> expected = {1, 1, 1, 4, 4, 4, 7, 7, 7};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(frameAt(p, sequence, static_cast<double>(i) / 10).value, expected[i]);
}

// --- Documents ---

TEST(SceneDocuments, AreRefusedWithThePlaceOfWhatIsWrong) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<std::function<void(SceneDocument&)>, std::string>> bad = {
      {[&](SceneDocument& d) { d.performances[0].speed = -1; }, "performances[0].speed"},
      {[&](SceneDocument& d) { d.performances[0].time_offset_s = inf; }, "performances[0].time_offset_s"},
      {[&](SceneDocument& d) { d.performances[0].scene_from_performance.scale = 0; },
       "performances[0].scene_from_performance: expected a scale over 0"},
      {[&](SceneDocument& d) { d.meshes[0].scene_from_mesh.rotation[0][0] = -1; },
       "meshes[0].scene_from_mesh.rotation"},
      {[&](SceneDocument& d) { d.meshes[0].scene_from_mesh.rotation *= 1.1; }, "rotation"},
      {[&](SceneDocument& d) { d.meshes[0].base_color.y = 1.5; }, "meshes[0].base_color.g"},
      {[&](SceneDocument& d) { d.ground.roughness = 0; }, "ground.roughness"},
      {[&](SceneDocument& d) { d.look.lighting.lights[0].id = "?"; }, "look.lights[0]"},
      {[&](SceneDocument& d) { d.performances.resize(kMostPerformances + 1); },
       "performances: expected at most"}};
  for (const auto& [spoil, told] : bad) {
    Stage stage;
    validate(stage.document);
    spoil(stage.document);
    try {
      validate(stage.document);
      ADD_FAILURE() << told;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), Error::Kind::Data);
      EXPECT_THAT(e.what(), HasSubstr(told));
    }
  }
}

TEST(SceneDocuments, EveryFieldCountsInEquality) {
  const auto counts = [](const auto& value) {
    testing::changeEachField(
        value, [&](const std::string& name, const auto& other) { EXPECT_NE(other, value) << name; });
  };
  [[maybe_unused]] const auto& [a, b, placement, c, d, unknown] = Performance{};
  EXPECT_EQ(fieldsOf(Performance{}).size(), 5u) << "a file counts twice";
  [[maybe_unused]] const auto& [e, mesh_placement, f, g, mesh_unknown] = SceneMesh{};
  EXPECT_EQ(fieldsOf(SceneMesh{}).size(), 6u);
  [[maybe_unused]] const auto& [h, i, j, k, ground_unknown] = Ground{};
  EXPECT_EQ(fieldsOf(Ground{}).size(), 6u);
  counts(Performance{});
  counts(SceneMesh{});
  counts(Ground{});
}

}  // namespace
}  // namespace beam
