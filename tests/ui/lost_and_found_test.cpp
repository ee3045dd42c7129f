// SPDX-License-Identifier: Apache-2.0
// What stays in view and what can be done when settings changed, the capture moved, or project.json broke.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QAction>
#include <QApplication>
#include <QMessageBox>
#include <QPushButton>
#include <QTimer>

#include "core/io/file.h"
#include "tests/support/stand_in_studio.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "ui/main_window.h"
#include "ui/message_panel.h"
#include "ui/run_bar.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using testing::TempDir;
using testing::waitFor;

class LostAndFound : public ::testing::Test {
 protected:
  LostAndFound() : window(testing::standInServices(), MainWindow::Layout::Fresh) {
    testing::holdStandInRuns(false);
    testing::copySolvedStandIn(folder.path());
    writeFileAtomically(folder / "capture" / "dataset.json", "{}");  // to be known by
    window.setAsksBeforeClosing(false);
    window.show();
  }
  bool open(const fs::path& path) {
    window.open(path);
    return waitFor([&] { return window.model().isOpen() && window.settled(); });
  }
  bool enabled(const char* command) { return window.commands().action(command)->isEnabled(); }
  bool run() {
    window.run();
    return waitFor([&] { return !window.job().busy() && window.settled(); });
  }

  // Another value of the first number of Surface.
  void changeSurface() {
    for (const Field& field : window.model().project().fields()) {
      if (!field.info.name.starts_with("surface.") || !std::holds_alternative<int>(field.value)) continue;
      return window.model().set(field.info.name, FieldValue(std::get<int>(field.value) + 1));
    }
    FAIL() << "the stand-in has no such setting";
  }

  TempDir folder;
  MainWindow window;
};

TEST_F(LostAndFound, AResultOfOtherSettingsStaysInViewUntilTheNewOneIsThere) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  ASSERT_TRUE(window.model().values().materials);
  EXPECT_FALSE(window.model().values().stale);
  changeSurface();
  ASSERT_TRUE(waitFor([&] { return window.settled() && window.model().values().stale; }));
  EXPECT_TRUE(window.model().values().materials) << "what was solved stays in view";
  ASSERT_TRUE(run());
  EXPECT_TRUE(window.model().values().materials);
  EXPECT_FALSE(window.model().values().stale);
}

TEST_F(LostAndFound, ThePreviewOfACancelledRunStays) {
  ASSERT_TRUE(open(folder / "capture"));
  changeSurface();
  testing::holdStandInRuns(true);
  bool preview = false;
  QObject::connect(&window.job(), &JobBridge::previewChanged, &window, [&] { preview = true; });
  window.run();
  ASSERT_TRUE(waitFor([&] { return preview; }));
  window.cancelRun();
  ASSERT_TRUE(waitFor([&] { return !window.job().busy() && window.settled(); }));
  EXPECT_TRUE(window.showsPreview());
  testing::holdStandInRuns(false);
  ASSERT_TRUE(run());
  EXPECT_FALSE(window.showsPreview());
}

TEST_F(LostAndFound, SolvedResultsOpenWithoutTheCaptureWhichCanBeLocated) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  ASSERT_TRUE(window.model().save());
  fs::rename(folder / "capture", folder / "elsewhere");
  window.open(folder / "capture.beam");
  ASSERT_TRUE(waitFor([&] { return window.model().captureLost() && window.settled(); }));
  EXPECT_TRUE(window.model().values().cloud) << "what is solved can be looked at";
  EXPECT_TRUE(window.message().isVisible());
  EXPECT_FALSE(enabled("run_frame"));
  ASSERT_TRUE(enabled("locate_capture"));
  window.model().locateCapture(folder / "elsewhere");
  ASSERT_TRUE(waitFor([&] { return !window.model().captureLost() && window.settled(); }))
      << window.message().text().toStdString();
  EXPECT_TRUE(enabled("run_frame"));
  EXPECT_FALSE(enabled("locate_capture"));
}

TEST_F(LostAndFound, AnotherCaptureIsTakenOnlyWhenItIsMeant) {
  fs::remove_all(folder / "capture.beam");  // it was made when nothing described the capture
  ASSERT_TRUE(open(folder / "capture"));
  ASSERT_TRUE(window.model().save());
  fs::rename(folder / "capture", folder / "elsewhere");
  fs::create_directories(folder / "other");
  writeFileAtomically(folder / "other" / "dataset.json", "{ }");
  ASSERT_TRUE(waitFor([&] { return window.model().captureLost() && window.settled(); }));
  const auto answer = [&](const QString& words) {
    bool asked = false;
    QTimer timer;
    QObject::connect(&timer, &QTimer::timeout, [&] {
      auto* question = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
      if (!question) return;
      asked = true;
      EXPECT_TRUE(question->text().contains("dataset.json")) << question->text().toStdString();
      for (QAbstractButton* button : question->buttons())
        if (button->text().remove("&") == words) button->click();
    });
    timer.start(50);
    window.model().locateCapture(folder / "other");
    return waitFor([&] { return asked && !QApplication::activeModalWidget() && window.settled(); });
  };
  ASSERT_TRUE(answer("Cancel"));
  EXPECT_TRUE(window.model().captureLost());
  ASSERT_TRUE(answer("Use it all the same"));
  EXPECT_FALSE(window.model().captureLost());
  EXPECT_EQ(window.model().project().captureFolder().filename(), "other");
}

TEST_F(LostAndFound, ACaptureThatGoesWhileItIsOpenIsSaidAndWelcomedBack) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  fs::rename(folder / "capture", folder / "elsewhere");
  ASSERT_TRUE(waitFor([&] { return window.model().captureLost(); }));
  EXPECT_EQ(window.model().stages().front().state, StepState::Blocked);
  EXPECT_TRUE(window.model().values().cloud);
  EXPECT_FALSE(enabled("run_frame"));
  fs::rename(folder / "elsewhere", folder / "capture");
  ASSERT_TRUE(waitFor([&] { return !window.model().captureLost() && window.settled(); }));
  EXPECT_EQ(window.model().stages().front().state, StepState::Done);
}

TEST_F(LostAndFound, AProjectWithProblemsCloses) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  writeFileAtomically(folder / "bad.exr", "no panorama");
  window.open(folder / "bad.exr");
  ASSERT_TRUE(waitFor([&] { return window.message().isVisible() && window.settled(); }));
  window.commands().action("close_project")->trigger();
  ASSERT_TRUE(waitFor([&] { return !window.model().isOpen(); }));
  EXPECT_TRUE(open(folder / "capture.beam"));
}

TEST_F(LostAndFound, ASettingThatNoStageTakesIsSaidLikeABrokenProject) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  window.commands().action("close_project")->trigger();
  std::string text = readTextFile(folder / "capture.beam" / "project.json");
  const std::size_t at = text.find("\"settings\": {}");
  ASSERT_NE(at, std::string::npos) << text;
  text.replace(at, 14, "\"settings\": {\"surface.steps\": \"abc\"}");
  writeFileAtomically(folder / "capture.beam" / "project.json", text);
  window.open(folder / "capture.beam");
  ASSERT_TRUE(waitFor([&] { return window.message().isVisible(); }));
  EXPECT_FALSE(window.model().isOpen());
  EXPECT_TRUE(enabled("earlier_versions")) << window.message().text().toStdString();
}

TEST_F(LostAndFound, SolvedResultsOpenWithoutThePanoramaWhichCanBeNamed) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  writeFileAtomically(folder / "sky.exr", "light");
  window.model().setEnvironment(folder / "sky.exr");
  ASSERT_TRUE(window.model().save());
  fs::remove(folder / "sky.exr");
  window.open(folder / "capture.beam");
  ASSERT_TRUE(waitFor([&] { return window.message().isVisible() && window.settled(); }));
  EXPECT_TRUE(window.model().values().cloud) << "what is solved can be looked at";
  EXPECT_TRUE(enabled("capture_light"));
}

TEST_F(LostAndFound, AProjectThatIsGoneIsNotMadeASecondTime) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  fs::rename(folder / "capture.beam", folder / "gone.beam");
  changeSurface();
  EXPECT_FALSE(window.model().save());
  EXPECT_TRUE(window.message().text().contains("not there any more"))
      << window.message().text().toStdString();
  EXPECT_FALSE(fs::exists(folder / "capture.beam"));
  window.run();
  EXPECT_FALSE(window.job().busy());
}

TEST_F(LostAndFound, ARunWhoseCaptureGoesEndsWithThatWord) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  changeSurface();
  testing::holdStandInRuns(true);
  window.run();
  ASSERT_TRUE(waitFor([&] { return window.job().busy(); }));
  fs::rename(folder / "capture", folder / "elsewhere");
  testing::holdStandInRuns(false);
  ASSERT_TRUE(waitFor([&] { return !window.job().busy() && window.model().captureLost(); }));
  EXPECT_EQ(window.message().title(), "The capture is not where it was");
}

TEST_F(LostAndFound, ARunThatOutlivesItsCaptureEndsWithThatWord) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  changeSurface();
  testing::holdStandInRuns(true);
  window.run();
  ASSERT_TRUE(waitFor([&] { return window.job().busy(); }));
  fs::rename(folder / "capture", folder / "elsewhere");
  ASSERT_TRUE(waitFor([&] { return window.model().captureLost(); }));
  testing::holdStandInRuns(false);
  ASSERT_TRUE(waitFor([&] { return !window.job().busy(); }));
  EXPECT_EQ(window.message().title(), "The capture is not where it was");
  EXPECT_TRUE(enabled("locate_capture"));
  for (const StageStatus& stage : window.model().stages()) EXPECT_EQ(stage.running, 0) << stage.id;
}

TEST_F(LostAndFound, ACaptureIsRecentOnceItsProjectIsOnDisk) {
  fs::remove_all(folder / "capture.beam");
  ASSERT_TRUE(open(folder / "capture"));
  const auto listed = [&] {
    for (const auto* link : window.findChildren<QPushButton*>("recent"))
      if (link->text().contains("capture.beam")) return true;
    return false;
  };
  EXPECT_FALSE(listed());
  ASSERT_TRUE(window.model().save());
  EXPECT_TRUE(listed());
}

TEST_F(LostAndFound, SettingsThatAreNowhereOnDiskAreAskedFor) {
  fs::remove_all(folder / "capture.beam");
  ASSERT_TRUE(open(folder / "capture"));
  window.setAsksBeforeClosing(true);
  changeSurface();
  const auto answer = [&](const QString& words) {
    QTimer::singleShot(100, &window, [words] {
      auto* question = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
      ASSERT_NE(question, nullptr);
      for (QAbstractButton* button : question->buttons())
        if (button->text().remove("&") == words) return button->click();
    });
    window.commands().action("close_project")->trigger();
  };
  answer("Cancel");
  EXPECT_TRUE(window.model().isOpen());
  EXPECT_FALSE(fs::exists(folder / "capture.beam"));
  answer("Save");
  EXPECT_FALSE(window.model().isOpen());
  EXPECT_TRUE(fs::exists(folder / "capture.beam" / "project.json"));
}

TEST_F(LostAndFound, AWordOfAFailureGoesWhenItIsMended) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  fs::rename(folder / "capture.beam", folder / "gone.beam");
  changeSurface();
  EXPECT_FALSE(window.model().save());
  ASSERT_TRUE(window.message().isVisible());
  fs::rename(folder / "gone.beam", folder / "capture.beam");
  window.commands().action("save_settings")->trigger();
  EXPECT_FALSE(window.message().isVisible()) << window.message().text().toStdString();
  ASSERT_TRUE(waitFor([&] { return window.settled(); }));
  EXPECT_TRUE(window.model().values().cloud);
}

TEST_F(LostAndFound, ABrokenProjectOffersItsEarlierVersionsInWords) {
  writeFileAtomically(folder / "capture.beam" / "project.json", "{ half");
  window.open(folder / "capture.beam");
  ASSERT_TRUE(waitFor([&] { return window.message().isVisible(); }));
  EXPECT_FALSE(window.message().text().contains("exception")) << window.message().text().toStdString();
  EXPECT_TRUE(enabled("earlier_versions"))
      << window.message().title().toStdString() << ": " << window.message().text().toStdString();
}

}  // namespace
}  // namespace beam
