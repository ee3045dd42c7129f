// SPDX-License-Identifier: Apache-2.0
// The timeline over a take of six small frames on a virtual display: lanes, going to a frame, playing,
// running a range while another frame is looked at.
#include <gtest/gtest.h>

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>

#include <atomic>
#include <cmath>
#include <set>
#include <thread>
#include <utility>

#include "core/io/file.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/scene/pose.h"
#include "core/stages/carried_skin.h"
#include "core/stages/result_files.h"
#include "core/stages/step_ids.h"
#include "core/stages/track_files.h"
#include "tests/support/splat_shapes.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "ui/main_window.h"
#include "ui/timeline_panel.h"
#include "viewers/gl/functions.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using testing::TempDir;
using testing::waitFor;

constexpr int kFrames = 6;
constexpr int kRestart = 4;  // the joints begin anew there

TakeSurvey surveyOf(std::vector<CellState> surface, std::vector<CellState> materials) {
  TakeSurvey survey;
  survey.frames.resize(surface.size());
  std::vector<std::string> notes(surface.size());
  survey.lanes = {{"surface", "Surface", "", std::move(surface), notes},
                  {"materials", "Materials", "", std::move(materials), notes}};
  return survey;
}

TEST(LaneShade, ShowsWhatIsOnDiskWhereNoRunGoesOn) {
  using enum CellState;
  const TakeSurvey survey = surveyOf({Done, Stale, Failed, Empty}, {Running, Blocked, Empty, Empty});
  RunOverlay none;
  none.frames = {0, 1, 2, 3};
  EXPECT_EQ(shadeOf(survey, 0, 0, none), LaneShade::Done);
  EXPECT_EQ(shadeOf(survey, 0, 1, none), LaneShade::Stale);
  EXPECT_EQ(shadeOf(survey, 0, 2, none), LaneShade::Failed);
  const TakeSurvey scout = surveyOf({Done, Interpolated, Done}, {Empty, Empty, Empty});
  EXPECT_EQ(shadeOf(scout, 0, 1, none), LaneShade::Interpolated);
  EXPECT_EQ(shadeOf(survey, 0, 3, none), LaneShade::Empty);
  EXPECT_EQ(shadeOf(survey, 1, 0, none), LaneShade::Running);
  EXPECT_EQ(shadeOf(survey, 1, 1, none), LaneShade::Blocked);
}

TEST(LaneShade, QueuesTheRunsFramesUntilItsLastStage) {
  using enum CellState;
  const TakeSurvey survey = surveyOf({Done, Stale, Empty, Empty}, {Empty, Empty, Empty, Empty});
  RunOverlay run{{0, 1, 2}, "surface", "surface", 1, true};
  EXPECT_EQ(shadeOf(survey, 0, 0, run), LaneShade::Done);
  EXPECT_EQ(shadeOf(survey, 0, 1, run), LaneShade::Running);
  EXPECT_EQ(shadeOf(survey, 0, 2, run), LaneShade::Queued);
  EXPECT_EQ(shadeOf(survey, 0, 3, run), LaneShade::Empty) << "not in the run";
  EXPECT_EQ(shadeOf(survey, 1, 2, run), LaneShade::Empty) << "beyond its last stage";
  run.until.clear();
  EXPECT_EQ(shadeOf(survey, 1, 2, run), LaneShade::Queued);
}

struct BallOptions {
  int size = 40;
};
void describe(Fields& f, BallOptions& o) {
  f.field({.name = "size", .label = "Size", .help = "Gaussians.", .min = 1, .max = 1e6}, o.size);
}

GaussianCloud ballAt(float frame, int size) {
  GaussianCloud cloud;
  testing::addSphere(cloud, vec3(0.1f * frame, 1, 0), 0.3f, size);
  return cloud;
}

// One at either side of the ball.
GaussianCloud jointsAt(float frame) {
  GaussianCloud joints;
  for (const float side : {-0.3f, 0.3f})
    testing::addSplat(joints, vec3(0.1f * frame + side, 1, 0), vec3(0, 0, 1), 0.1f, 0.01f);
  return joints;
}

std::atomic<int> g_held_frame{-1};  // a step of this frame waits until it is another

// Writes a ball that wanders with the frame.
class BallStage final : public StageOf<BallOptions> {
 public:
  explicit BallStage(StageInfo info) : info_(std::move(info)) {}
  const StageInfo& info() const override { return info_; }
  void run(std::string_view step, StepContext& c) const override {
    if (step == "seed") return writeFileAtomically(c.folder / "seeds.txt", "nothing to see");
    while (g_held_frame == c.frame.value) {
      c.progress.check();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const auto at = static_cast<float>(c.frame.value);
    const GaussianCloud cloud = ballAt(at), joints = jointsAt(at);
    c.scores["gaussians"] = static_cast<double>(cloud.size()) + c.frame.value;
    if (info_.id == "track") {
      writePosePly(c.folder / kRestPoseFile, poseOf(jointsAt(0)));
      writeTrackNote(c.folder, {c.frame.value == kRestart, 1});
      return writeSplatPly(c.folder / kJointsFile, joints, nullptr);
    }
    if (info_.id == "surface") {
      if (c.later()) {
        writePosePly(c.folder / kRestPoseFile, poseOf(ballAt(0)));
        writePosePly(c.folder / kJointPoseFile, poseOf(joints));
      }
      return writeSplatPly(c.folder / kCloudFile, cloud, nullptr);
    }
    Materials m;
    m.roughness.assign(cloud.size(), 0.5f);
    m.base_color = ShBlock(cloud.size(), 3);
    m.ambient_occlusion = ShBlock(cloud.size(), 1);
    writeSplatPly(c.folder / kMaterialsFile, cloud, &m);
  }

 private:
  GaussianCloud ballAt(float frame) const { return beam::ballAt(frame, options_.size); }

  StageInfo info_;
};

std::atomic<int> g_tint{0};  // added to every picture

// Every frame has a picture of its own.
class PlainPictures final : public FrameSource {
 public:
  bool has(ViewIndex, FrameIndex) const override { return true; }
  Image<u8vec3> photo(ViewIndex, FrameIndex frame) const override {
    return Image<u8vec3>(200, 200, u8vec3(static_cast<std::uint8_t>(frame.value + g_tint)));
  }
  Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return {}; }
};

ImportedCapture take(const fs::path&, const ImportOptions&) {
  ImportedCapture imported;
  imported.set.name = "take";
  imported.set.views.push_back({"cam", {{300, 300, 100, 100}, 200, 200, {}}, Split::Train});
  for (int f = 0; f < kFrames; ++f) imported.set.frames.push_back("00000" + std::to_string(f));
  imported.set.frames_per_second = 25;
  imported.set.source = std::make_shared<PlainPictures>();
  imported.layout = "memory";
  return imported;
}

class Timeline : public ::testing::Test {
 protected:
  explicit Timeline(bool solved = false) : window(services(), MainWindow::Layout::Fresh) {
    g_held_frame = -1;
    g_tint = 0;
    if (solved) fs::copy(solvedTake(), folder.path(), fs::copy_options::recursive);
    fs::create_directories(folder / "capture");
    window.show();
    window.open(folder / "capture");
    EXPECT_TRUE(waitFor([&] { return window.model().isOpen() && window.settled(); }));
  }
  static StudioServices services() {
    auto setup = std::make_shared<PipelineSetup>();
    const std::vector<Reads> pictures{Reads::Pictures};
    setup->stages.add([=] {
      return std::make_unique<BallStage>(
          StageInfo{"surface",
                    "Surface",
                    "",
                    {{.id = "seed", .title = "Seed", .reads = pictures},
                     {.id = "fit", .title = "Fit", .inputs = {kSeedStep}, .shown = {.frame = true}},
                     {.id = "refine",
                      .title = "Refine",
                      .inputs = {kFitStep},
                      .later = {.previous = {kRefineStep}},
                      .shown = {.frame = true, .surface = kRefineStep}},
                     {.id = "mesh",
                      .title = "Mesh",
                      .inputs = {kRefineStep},
                      .shown = {.frame = true, .surface = kRefineStep}}}});
    });
    setup->stages.add([] {
      return std::make_unique<BallStage>(
          StageInfo{"materials",
                    "Materials",
                    "",
                    {{.id = "fit",
                      .title = "Fit",
                      .inputs = {kRefineStep},
                      .shown = {.frame = true, .surface = kRefineStep, .last = true}}}});
    });
    setup->stages.add([] {
      return std::make_unique<BallStage>(
          StageInfo{"track", "Track", "", {{.id = "joints", .title = "Joints", .inputs = {kRefineStep}}}});
    });
    setup->open_capture = take;
    const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
    return {.pipeline = setup,
            .job_device = device,
            .new_renderer = cpuSceneRenderers(device),
            .make_sample = {},
            .version = "test"};
  }
  // A folder with the capture and its finished project, made once.
  static fs::path solvedTake() {
    static const TempDir folder;
    static bool made = false;
    if (std::exchange(made, true)) return folder.path();
    fs::create_directories(folder / "capture");
    const StudioServices with = services();
    Project project = Project::create(folder / "capture.beam", {}, with.pipeline);
    project.setCapture(folder / "capture");
    project.save();
    Runner runner;
    runner.start(project, {}, with.job_device);
    while (runner.running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return folder.path();
  }
  void runToTheEnd(RunScope scope, const std::string& until = {}) {
    window.run(until, scope);
    ASSERT_TRUE(waitFor([&] { return !window.job().busy() && window.settled(); }));
  }
  CellState cell(std::size_t lane, int frame) { return window.model().survey()->lanes[lane].cells[frame]; }
  void key(int code) {
    QKeyEvent press(QEvent::KeyPress, code, Qt::NoModifier);
    QApplication::sendEvent(&window, &press);
  }

  TempDir folder;
  MainWindow window;
};

class SolvedTimeline : public Timeline {
 protected:
  SolvedTimeline() : Timeline(true) {}
};

TEST_F(Timeline, GoesToTheFrameThatIsPressedAndDraggedTo) {
  TimelineLanes& lanes = window.timeline().lanes();
  ASSERT_TRUE(waitFor([&] { return lanes.frameAt(lanes.centerOf(4)) == 4; }));
  QMouseEvent press(QEvent::MouseButtonPress, QPointF(lanes.centerOf(4), 30), Qt::LeftButton, Qt::LeftButton,
                    Qt::NoModifier);
  QApplication::sendEvent(&lanes, &press);
  EXPECT_EQ(window.model().frame().value, 4);
  QMouseEvent move(QEvent::MouseMove, QPointF(lanes.centerOf(2), 30), Qt::NoButton, Qt::LeftButton,
                   Qt::NoModifier);
  QApplication::sendEvent(&lanes, &move);
  EXPECT_EQ(window.model().frame().value, 2);
  EXPECT_EQ(lanes.frameAt(-100), 0);
  EXPECT_EQ(lanes.frameAt(1e6), kFrames - 1);
}

TEST_F(Timeline, KeysStepSetThePointsAndStopAtTheEnds) {
  key(Qt::Key_Right);
  key(Qt::Key_Right);
  EXPECT_EQ(window.model().frame().value, 2);
  key(Qt::Key_I);
  key(Qt::Key_End);
  EXPECT_EQ(window.model().frame().value, kFrames - 1);
  key(Qt::Key_Right);
  EXPECT_EQ(window.model().frame().value, kFrames - 1);
  key(Qt::Key_Left);
  key(Qt::Key_O);
  EXPECT_EQ(window.player().range(), (FrameRange{2, 4}));
  key(Qt::Key_Home);
  EXPECT_EQ(window.model().frame().value, 2);
  key(Qt::Key_End);
  EXPECT_EQ(window.model().frame().value, 4);
}

TEST_F(Timeline, RunsTheRangeAloneAndHoldsTheNearestSolvedFrame) {
  window.player().setIn(1);
  window.player().setOut(2);
  runToTheEnd(RunScope::Range, "materials");
  for (int f = 0; f < kFrames; ++f) {
    EXPECT_EQ(cell(1, f), f == 1 || f == 2 ? CellState::Done : CellState::Empty) << f;
  }
  EXPECT_FALSE(window.model().values().cloud) << "frame 0 has no result";
  ASSERT_TRUE(window.model().held());
  EXPECT_EQ(window.model().held()->from.value, 1);
  window.player().goTo(2);
  ASSERT_TRUE(waitFor([&] { return window.settled(); }));
  EXPECT_TRUE(window.model().values().materials);
  EXPECT_FALSE(window.model().held());
}

// Frames 0 2 4 are solved, 1 and 3 lie between, 5 is behind the last.
TEST_F(Timeline, ScoutsTheRangeAndShowsWhatLiesBetween) {
  window.player().goTo(1);
  window.run({}, RunScope::Scout, 2);
  ASSERT_TRUE(waitFor([&] { return !window.job().busy() && window.settled(); }));
  using enum CellState;
  EXPECT_EQ(window.model().survey()->lanes[0].cells,
            (std::vector{Done, Interpolated, Done, Interpolated, Done, Empty}));
  ASSERT_TRUE(window.model().values().cloud);
  EXPECT_TRUE(window.model().values().interpolated);
  EXPECT_TRUE(window.model().values().materials);
  const vec3 first = window.model().values().cloud->position_m[0];
  window.showView(StudioView::Scene);
  ASSERT_TRUE(waitFor([&] { return window.settled() && window.joints().shown().trails.size() == 2; }));
  EXPECT_NEAR(window.joints().shown().trails[1][1].x, 0.1f + 0.3f, 1e-6) << "joints between those of 0 and 2";
  window.joints().pick(0);
  EXPECT_TRUE(waitFor([&] { return window.settled() && window.joints().shown().influence != nullptr; }));
  window.player().goTo(2);
  ASSERT_TRUE(waitFor([&] { return window.settled(); }));
  EXPECT_FALSE(window.model().values().interpolated);
  EXPECT_NEAR(window.model().values().cloud->position_m[0].x - first.x, 0.1, 1e-4);
  window.player().goTo(5);
  ASSERT_TRUE(waitFor([&] { return window.settled(); }));
  ASSERT_TRUE(window.model().held());
  EXPECT_EQ(window.model().held()->from.value, 4);
  // A setting of surface: what lies between goes with what it lies between.
  window.player().goTo(1);
  window.model().set("surface.size", FieldValue(41));
  ASSERT_TRUE(waitFor([&] { return window.settled() && !window.model().values().cloud; }));
}

TEST(Scout, SaysWhatItWillTake) {
  TakeSurvey survey;
  survey.curves = {{"surface.fit.seconds", {60, NAN, 20}},
                   {"surface.fit.loss", {5, 5, 5}},
                   {"materials.fit.seconds", {10, NAN, 30}}};
  EXPECT_EQ(secondsAFrame(survey), 60);
  EXPECT_EQ(secondsAFrame({}), 0);
  const QString words = scoutText({25, 60, "draft"}, 10);
  EXPECT_TRUE(words.contains("3 of 25 frames")) << words.toStdString();
  EXPECT_TRUE(words.contains("3 min 00 s"));
  EXPECT_TRUE(words.contains("18 between"));
  EXPECT_TRUE(words.contains("4 after"));
}

TEST_F(SolvedTimeline, OffersTheScoresOfTheTakeAsCurves) {
  EXPECT_FALSE(window.timeline().chooseCurve("materials.fit.beauty"));
  ASSERT_TRUE(window.timeline().chooseCurve("materials.fit.gaussians"));
  const SurveyCurve* curve = window.model().survey()->curve("materials.fit.gaussians");
  EXPECT_EQ(curve->values[3] - curve->values[0], 3);
}

TEST_F(SolvedTimeline, HasRoomForTheCurveUnderManyLanes) {
  TimelineLanes& lanes = window.timeline().lanes();
  ASSERT_TRUE(window.timeline().chooseCurve("materials.fit.gaussians"));
  auto many = std::make_shared<TakeSurvey>(*window.model().survey());
  many->lanes.resize(7, many->lanes[0]);
  lanes.setSurvey(many);
  EXPECT_TRUE(waitFor(
      [&] {
        return lanes.height() >= lanes.sizeHint().height() &&
               lanes.visibleRegion().boundingRect().height() == lanes.height();
      },
      3000))
      << lanes.visibleRegion().boundingRect().height() << " of " << lanes.sizeHint().height();
}

TEST_F(SolvedTimeline, PlaysInTheRangeFromMemoryAndSaysTheRate) {
  window.player().setIn(1);
  window.player().setOut(4);
  std::set<int> seen;
  QObject::connect(&window.model(), &ProjectModel::frameChanged, &window,
                   [&] { seen.insert(window.model().frame().value); });
  key(Qt::Key_Space);
  ASSERT_TRUE(window.player().playing());
  ASSERT_TRUE(waitFor([&] { return seen.size() == 4 && window.player().clock().rate() > 0; }));
  EXPECT_EQ(seen, (std::set<int>{1, 2, 3, 4}));
  EXPECT_TRUE(waitFor([&] { return window.timeline().text().contains("of 25 fps"); }))
      << window.timeline().text().toStdString();
  key(Qt::Key_Space);
  EXPECT_FALSE(window.player().playing());
  ASSERT_TRUE(waitFor([&] { return window.settled(); }));
  EXPECT_TRUE(window.model().values().materials);
  const std::vector<bool> held = window.model().cache().held(*window.model().sequence());
  EXPECT_EQ(std::count(held.begin() + 1, held.begin() + 5, true), 4);
}

TEST_F(SolvedTimeline, StopsAtTheOutPointWithoutALoop) {
  window.player().setLoop(false);
  window.player().goTo(3);
  window.player().play();
  ASSERT_TRUE(waitFor([&] { return !window.player().playing(); }));
  EXPECT_EQ(window.model().frame().value, kFrames - 1);
  EXPECT_TRUE(waitFor([&] { return window.settled(); }));
}

// Frames 0 to 2 are there, 3 is at work: the take plays, and shows what is solved.
TEST_F(Timeline, PlaysWhileLaterFramesAreStillBeingSolved) {
  g_held_frame = 3;
  window.player().setOut(3);
  window.run({}, RunScope::Range);
  ASSERT_TRUE(waitFor([&] { return window.model().survey() && cell(1, 2) == CellState::Done; }));
  ASSERT_TRUE(waitFor([&] { return window.model().survey()->stamps[3] != Digest{}; }))
      << "its seeds are there";
  window.player().goTo(3);
  ASSERT_TRUE(waitFor([&] { return window.model().valuesReady(); }));
  ASSERT_TRUE(window.model().held()) << "seeds are nothing to see";
  EXPECT_EQ(window.model().held()->from.value, 2);
  window.player().setOut(2);
  window.player().play();
  ASSERT_TRUE(waitFor([&] { return window.player().clock().rate() > 0; }));
  EXPECT_TRUE(window.job().busy());
  EXPECT_TRUE(window.model().values().materials);
  g_held_frame = -1;
  ASSERT_TRUE(waitFor([&] { return !window.job().busy() && cell(1, 3) == CellState::Done; }));
  EXPECT_TRUE(window.player().playing()) << "the end of a run does not stop the picture";
  window.player().pause();
  EXPECT_TRUE(waitFor([&] { return window.settled(); }));
}

TEST_F(Timeline, ShowsANewResultOfTheShownFrame) {
  runToTheEnd(RunScope::Frame, "surface");
  ASSERT_TRUE(window.model().values().cloud);
  EXPECT_FALSE(window.model().values().materials);
  runToTheEnd(RunScope::Frame, "materials");
  EXPECT_TRUE(waitFor([&] { return window.model().values().materials != nullptr; }));
}

TEST_F(Timeline, SeesAfterARunThatPicturesOfTheCaptureHaveChanged) {
  runToTheEnd(RunScope::Frame, "materials");
  ASSERT_EQ(cell(1, 0), CellState::Done);
  g_tint = 100;
  runToTheEnd(RunScope::Frame, "surface");
  EXPECT_EQ(cell(0, 0), CellState::Done);
  EXPECT_EQ(cell(1, 0), CellState::Stale) << "made from the old pictures";
}

TEST(Influence, IsTheWeightOfTheJointAmongTheAnchors) {
  const Anchors anchors{2, {0, 1, 2, 0}, {0.75f, 0.25f, 0.5f, 0.5f}};
  EXPECT_EQ(influenceOf(anchors, 0), (std::vector<float>{0.75f, 0.5f}));
  EXPECT_EQ(influenceOf(anchors, 1), (std::vector<float>{0.25f, 0.0f}));
  EXPECT_EQ(influenceOf(anchors, 7), (std::vector<float>{0.0f, 0.0f}));
}

TEST_F(Timeline, SaysHowToGetJointsWhereThereAreNone) {
  runToTheEnd(RunScope::Frame, "surface");
  window.showView(StudioView::Scene);
  ASSERT_TRUE(waitFor([&] { return window.settled() && !window.joints().shown().hint.isEmpty(); }));
  EXPECT_TRUE(window.joints().shown().hint.contains("run until Track"));
  EXPECT_TRUE(window.joints().shown().trails.empty());
}

TEST_F(SolvedTimeline, ShowsJointsWithTheirTrailsAndTheInfluenceOfThePickedOne) {
  window.showView(StudioView::Scene);
  window.player().goTo(3);
  ASSERT_TRUE(waitFor([&] { return window.settled() && window.joints().shown().trails.size() == 4; }));
  EXPECT_NEAR(window.joints().shown().trails[0][1].x, 0.3f, 1e-6);
  EXPECT_NEAR(window.joints().shown().trails[3][1].x, 0.6f, 1e-6);
  EXPECT_FALSE(window.joints().shown().influence);
  Q_EMIT window.sceneView().jointPicked(1);
  ASSERT_TRUE(waitFor([&] { return window.settled() && window.joints().shown().influence != nullptr; }));
  const GaussianCloud skin = ballAt(0, BallOptions().size);
  EXPECT_EQ(*window.joints().shown().influence, influenceOf(boundTo(poseOf(skin), poseOf(jointsAt(0))), 1));
  window.joints().pick(-1);
  EXPECT_TRUE(waitFor([&] { return window.settled() && window.joints().shown().influence == nullptr; }));
}

TEST_F(SolvedTimeline, JoinsNoJointsAcrossARestart) {
  window.showView(StudioView::Scene);
  window.player().goTo(kRestart + 1);
  ASSERT_TRUE(waitFor([&] { return window.settled() && !window.joints().shown().trails.empty(); }));
  ASSERT_TRUE(waitFor([&] { return window.settled() && window.joints().shown().trails.size() == 2; }))
      << window.joints().shown().trails.size();
  EXPECT_NEAR(window.joints().shown().trails[0][1].x, 0.1f * kRestart + 0.3f, 1e-6);
}

}  // namespace
}  // namespace beam
