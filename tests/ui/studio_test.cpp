// SPDX-License-Identifier: Apache-2.0
// The window and its parts on a virtual display: opening, running, cancelling, saying what went wrong.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QApplication>
#include <QDockWidget>
#include <QLineEdit>
#include <QMessageBox>
#include <QSettings>
#include <QTest>
#include <QTimer>

#include <thread>

#include "core/io/file.h"
#include "core/render/cpu_scene_renderer.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "ui/evaluation.h"
#include "ui/field_editors.h"
#include "ui/main_window.h"
#include "ui/message_panel.h"
#include "ui/parameter_form.h"
#include "ui/run_bar.h"
#include "ui/settings_panel.h"
#include "ui/stage_rail.h"
#include "viewers/gl/functions.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using testing::TempDir;
using testing::waitFor;

// A capture of a sphere, in memory.
class SphereSource final : public FrameSource {
 public:
  explicit SphereSource(std::vector<FrameView> views) : views_(std::move(views)) {}
  bool has(ViewIndex, FrameIndex) const override { return true; }
  Image<u8vec3> photo(ViewIndex view, FrameIndex) const override { return views_[view.value].photo; }
  Image<std::uint8_t> mask(ViewIndex view, FrameIndex) const override { return views_[view.value].mask; }

 private:
  std::vector<FrameView> views_;
};

ImportedCapture sphereCapture(const fs::path&, const ImportOptions&) {
  const std::vector<FrameView> views = testing::photographs({});
  ImportedCapture imported;
  imported.set.name = "sphere";
  for (const FrameView& view : views) imported.set.views.push_back({view.name, view.camera, Split::Train});
  imported.set.frames = {"000000"};
  imported.set.source = std::make_shared<SphereSource>(views);
  imported.layout = "memory";
  return imported;
}

// A stage that does nothing, for as long as it is let.
struct SleepOptions {
  int steps = 100000;
};
void describe(Fields& f, SleepOptions& o) {
  f.field({.name = "steps", .label = "Steps", .help = "Naps of a millisecond.", .min = 1, .max = 1e6},
          o.steps);
}
class SleepStage final : public StageOf<SleepOptions> {
 public:
  const StageInfo& info() const override {
    static const StageInfo kInfo{.id = "surface",
                                 .title = "Surface",
                                 .summary = "Sleeps.",
                                 .steps = {{.id = "fit", .title = "Sleep"}}};
    return kInfo;
  }
  void run(std::string_view, StepContext& c) const override {
    auto cloud = std::make_shared<GaussianCloud>();
    cloud->position_m.emplace_back(0, 1, 0);
    cloud->rotation.emplace_back(1, 0, 0, 0);
    cloud->scale_m.emplace_back(0.2f, 0.2f, 0.2f);
    cloud->opacity = {0.9f};
    cloud->color = ShBlock(1, 3);
    c.preview(cloud);
    c.progress.expect(options_.steps);
    for (int i = 0; i < options_.steps; ++i) {
      c.progress.step();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    writeFileAtomically(c.folder / "slept.txt", "well");
  }
};

class Studio : public ::testing::Test {
 protected:
  Studio() : window(services(), MainWindow::Layout::Fresh) {
    window.setAsksBeforeClosing(false);
    fs::create_directory(folder / "capture");
    window.show();
  }
  static StudioServices services() {
    auto setup = std::make_shared<PipelineSetup>();
    setup->stages.add([] { return std::make_unique<SleepStage>(); });
    setup->presets = "";
    setup->open_capture = sphereCapture;
    const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
    return {.pipeline = setup,
            .job_device = device,
            .new_renderer = cpuSceneRenderers(device),
            .make_sample = {},
            .version = "test"};
  }
  bool openCapture() {
    window.open(folder / "capture");
    return waitFor([&] { return window.model().isOpen() && window.settled(); });
  }

  TempDir folder;
  MainWindow window;
};

TEST_F(Studio, OpensACaptureAsAProjectThatIsOnDiskOnlyOnceItIsRun) {
  ASSERT_TRUE(openCapture());
  EXPECT_EQ(window.model().project().folder(), folder / "capture.beam");
  EXPECT_FALSE(fs::exists(folder / "capture.beam"));
  EXPECT_TRUE(fs::is_empty(folder / "capture")) << "nothing is written into a capture";
  ASSERT_EQ(window.model().stages().size(), 1u);
  EXPECT_EQ(window.model().stages()[0].state, StepState::Pending);
}

TEST_F(Studio, SaysWhatIsWrongWithAPathThatCannotBeOpened) {
  window.open(folder / "nowhere");
  ASSERT_TRUE(waitFor([&] { return window.message().isVisible(); }));
  EXPECT_TRUE(window.message().text().contains("nowhere"));
  EXPECT_FALSE(window.model().isOpen());
}

TEST_F(Studio, RunsAStageInTheBackgroundWithPreviewAndProgress) {
  ASSERT_TRUE(openCapture());
  window.model().set("surface.steps", FieldValue(2000));
  window.run();
  EXPECT_TRUE(window.job().busy());
  EXPECT_TRUE(waitFor([&] { return window.runBar().text().contains("2,000"); }))
      << window.runBar().text().toStdString();
  EXPECT_TRUE(waitFor([&] { return !window.job().busy() && window.settled(); }));
  EXPECT_TRUE(window.runBar().text().startsWith("Done")) << window.runBar().text().toStdString();
  EXPECT_EQ(window.model().stages()[0].state, StepState::Done);
  window.run();
  EXPECT_TRUE(waitFor([&] { return !window.job().busy(); }));
  EXPECT_TRUE(window.runBar().text().contains("1 there already")) << window.runBar().text().toStdString();
}

TEST_F(Studio, CancelsARunAndStaysUsable) {
  ASSERT_TRUE(openCapture());
  bool preview = false;
  QObject::connect(&window.job(), &JobBridge::previewChanged, &window, [&] { preview = true; });
  window.run();
  ASSERT_TRUE(waitFor([&] { return preview; }));
  window.cancelRun();
  EXPECT_TRUE(waitFor([&] { return !window.job().busy(); }, 2000));
  EXPECT_TRUE(window.runBar().text().startsWith("Cancelled")) << window.runBar().text().toStdString();
  EXPECT_TRUE(waitFor([&] { return window.settled(); }));
  EXPECT_EQ(window.model().stages()[0].state, StepState::Pending);
}

TEST_F(Studio, SaysThatItStopsAfterTheStepAndKeepsIt) {
  ASSERT_TRUE(openCapture());
  window.model().set("surface.steps", FieldValue(2000));
  window.run();
  ASSERT_TRUE(waitFor([&] { return window.runBar().text().contains("2,000"); }));
  window.commands().action("stop_after_step")->trigger();
  EXPECT_TRUE(window.runBar().text().contains("after this step")) << window.runBar().text().toStdString();
  ASSERT_TRUE(waitFor([&] { return !window.job().busy() && window.settled(); }));
  EXPECT_EQ(window.model().stages()[0].state, StepState::Done);
}

TEST_F(Studio, TakesAChangeDuringARunForTheNextOne) {
  ASSERT_TRUE(openCapture());
  window.model().set("surface.steps", FieldValue(2000));
  window.run();
  ASSERT_TRUE(waitFor([&] { return window.runBar().text().contains("2,000"); }));
  window.model().set("surface.steps", FieldValue(2001));
  ASSERT_TRUE(waitFor([&] { return !window.job().busy() && window.settled(); }));
  EXPECT_EQ(window.model().stages()[0].done, 0) << "of the settings in force, which are of the next run";
  EXPECT_EQ(window.model().stages()[0].stale_frames, 1);
}

TEST_F(Studio, AsksBeforeItClosesDuringARun) {
  window.setAsksBeforeClosing(true);
  ASSERT_TRUE(openCapture());
  window.run();
  ASSERT_TRUE(waitFor([&] { return window.runBar().text().contains("of"); }));
  const auto answer = [&](const QString& words) {
    QTimer::singleShot(100, &window, [words] {
      auto* question = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
      ASSERT_NE(question, nullptr);
      for (QAbstractButton* button : question->buttons()) {
        if (button->text() == words) button->click();
      }
    });
    window.close();
  };
  answer("Keep running");
  EXPECT_TRUE(window.job().busy());
  EXPECT_TRUE(window.isVisible());
  answer("Stop and close");
  EXPECT_TRUE(waitFor([&] { return !window.job().busy(); }, 5000));
}

TEST_F(Studio, KeepsAnEditedSettingInTheProject) {
  ASSERT_TRUE(openCapture());
  ASSERT_TRUE(window.model().save());
  window.settings().setStage("surface");
  Q_EMIT window.settings().form().edited("surface.steps", FieldValue(77));
  EXPECT_TRUE(window.settings().form().isMarkedChanged("surface.steps"));
  EXPECT_TRUE(waitFor([&] { return !window.model().unsaved(); }));
  const Project again = Project::open(folder / "capture.beam", window.model().services().pipeline);
  EXPECT_EQ(again.value("surface.steps"), FieldValue(77));
  Q_EMIT window.settings().form().resetWanted("surface.steps");
  EXPECT_FALSE(window.settings().form().isMarkedChanged("surface.steps"));
}

// What a person does: the tab is in front, the cursor in the field.
QLineEdit& enterField(MainWindow& window, const std::string& name) {
  QApplication::setActiveWindow(&window);
  Q_EMIT window.settings().attentionWanted();
  auto* line = window.settings().form().editor(name)->findChild<QLineEdit*>();
  QTest::mouseDClick(line, Qt::LeftButton);
  line->selectAll();
  return *line;
}

TEST_F(Studio, RunsWhatIsTypedThoughTheFieldWasNotLeft) {
  ASSERT_TRUE(openCapture());
  QLineEdit& line = enterField(window, "surface.steps");
  QTest::keyClicks(&line, "9");
  EXPECT_TRUE(line.hasFocus());
  QTest::keyClick(&line, Qt::Key_Return, Qt::ControlModifier);
  EXPECT_TRUE(window.job().busy());
  EXPECT_EQ(window.model().project().value("surface.steps"), FieldValue(9));
  EXPECT_TRUE(waitFor([&] { return !window.job().busy() && window.settled(); }));
  const Project saved = Project::open(folder / "capture.beam", window.model().services().pipeline);
  EXPECT_EQ(saved.value("surface.steps"), FieldValue(9));
}

TEST_F(Studio, StartsNoRunWithAValueThatCannotBeTakenAndNamesItsLabel) {
  ASSERT_TRUE(openCapture());
  QLineEdit& line = enterField(window, "surface.steps");
  QTest::keyClicks(&line, "abc");
  window.run();
  EXPECT_FALSE(window.job().busy());
  ASSERT_TRUE(window.message().isVisible());
  EXPECT_TRUE(
      window.message().text().contains("Steps expects a whole number from 1 to 1,000,000, found \"abc\""))
      << window.message().text().toStdString();
  EXPECT_EQ(line.text().toStdString(), "abc");
  EXPECT_TRUE(line.hasFocus());
  QTest::keyClick(&line, Qt::Key_Escape);
  window.run();
  EXPECT_TRUE(window.job().busy());
  window.cancelRun();
  EXPECT_TRUE(waitFor([&] { return !window.job().busy(); }));
}

TEST_F(Studio, BringsTheSettingsBackWhenOneOfThemIsWrong) {
  ASSERT_TRUE(openCapture());
  auto* inspector = window.findChild<QDockWidget*>("inspector");
  ASSERT_NE(inspector, nullptr);
  QTest::keyClicks(&enterField(window, "surface.steps"), "abc");
  inspector->close();
  window.run();
  EXPECT_FALSE(window.job().busy());
  EXPECT_TRUE(inspector->isVisible());
}

TEST_F(Studio, LooksFromTheOtherSideWhereverTheFocusIs) {
  ASSERT_TRUE(openCapture());
  window.showView(StudioView::Scene);
  window.activateWindow();
  window.rail().setFocus();
  const float before_rad = window.sceneView().orbit().azimuth_rad;
  QKeyEvent shortcut(QEvent::ShortcutOverride, Qt::Key_1, Qt::KeypadModifier | Qt::ControlModifier);
  shortcut.ignore();
  QApplication::sendEvent(&window.rail(), &shortcut);
  EXPECT_TRUE(shortcut.isAccepted()) << "else Ctrl+1 shows the splats";
  QKeyEvent press(QEvent::KeyPress, Qt::Key_1, Qt::KeypadModifier | Qt::ControlModifier);
  QApplication::sendEvent(&window.rail(), &press);
  EXPECT_NE(window.sceneView().orbit().azimuth_rad, before_rad);
}

TEST_F(Studio, SavesWhatIsTypedThoughTheFieldWasNotLeft) {
  ASSERT_TRUE(openCapture());
  QLineEdit& line = enterField(window, "surface.steps");
  QTest::keyClicks(&line, "23");
  QTest::keyClick(&line, Qt::Key_S, Qt::ControlModifier);
  const Project saved = Project::open(folder / "capture.beam", window.model().services().pipeline);
  EXPECT_EQ(saved.value("surface.steps"), FieldValue(23));
}

TEST_F(Studio, SaysDuringARunThatChangesAreForTheNextOne) {
  ASSERT_TRUE(openCapture());
  window.run();
  EXPECT_TRUE(window.settings().note().contains("next run"));
  window.cancelRun();
  EXPECT_TRUE(waitFor([&] { return !window.job().busy(); }));
  EXPECT_TRUE(window.settings().note().isEmpty());
}

TEST_F(Studio, KeepsTheSizesOfPanelsFromOneStartToTheNext) {
  constexpr int kWidth_px = 420;
  QCoreApplication::setOrganizationName("beam-tests");
  QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope, QString::fromStdString(folder.path()));
  const auto widthIn = [&](std::optional<int> wanted) {
    MainWindow kept(services(), MainWindow::Layout::Remembered);
    kept.setAsksBeforeClosing(false);
    kept.show();
    kept.open(folder / "capture");
    EXPECT_TRUE(waitFor([&] { return kept.model().isOpen() && kept.settled(); }));
    auto* inspector = kept.findChild<QDockWidget*>("inspector");
    if (wanted) kept.resizeDocks({inspector}, {*wanted}, Qt::Horizontal);
    QApplication::processEvents();
    const int width = inspector->width();
    kept.close();
    return width;
  };
  EXPECT_NEAR(widthIn(kWidth_px), kWidth_px, 2);
  EXPECT_NEAR(widthIn({}), kWidth_px, 2);
  EXPECT_NEAR(widthIn({}), kWidth_px, 2);
  QCoreApplication::setOrganizationName({});
}

TEST_F(Studio, ClosesDuringARun) {
  ASSERT_TRUE(openCapture());
  window.run();
  ASSERT_TRUE(waitFor([&] { return window.runBar().text().contains("of"); }));
  window.close();
  EXPECT_TRUE(waitFor([&] { return !window.job().busy(); }, 2000));
}

TEST(Evaluation, ReadsTheScoresThatEvaluateWroteAndLivesWithoutThem) {
  const TempDir folder;
  EXPECT_TRUE(readEvaluation(folder.path()).rows.empty());
  writeFileAtomically(
      folder / "evaluation.json",
      R"({"rgb": {"psnr": 33.456, "ssim": 0.97612, "pictures": 4}, "normal": {"angle_deg": 8.7},
                          "ao_scaled": {"psnr": 1}, "mesh": {"chamfer_mm": 2.357}})");
  const Evaluation evaluation = readEvaluation(folder.path());
  ASSERT_EQ(evaluation.rows.size(), 3u);
  EXPECT_EQ(evaluation.rows[0].first.toStdString(), "33.46 dB");
  EXPECT_EQ(evaluation.rows[0].ssim.toStdString(), "0.9761");
  EXPECT_EQ(evaluation.rows[1].first.toStdString(), "8.70°");
  EXPECT_EQ(evaluation.rows[2].first.toStdString(), "2.36 mm");
  writeFileAtomically(folder / "evaluation.json", "{ half");
  EXPECT_TRUE(readEvaluation(folder.path()).rows.empty());
}

}  // namespace
}  // namespace beam
