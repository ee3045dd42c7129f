// SPDX-License-Identifier: Apache-2.0
// Evaluate and Report of the menu: what they leave, how they are cancelled, why they cannot be done.
#include <gtest/gtest.h>

#include <QAction>
#include <QApplication>
#include <QDockWidget>
#include <QFileDialog>
#include <QLineEdit>
#include <QPushButton>
#include <QTimer>

#include "core/io/file.h"
#include "core/work/scores.h"
#include "tests/support/stand_in_studio.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "ui/elided_label.h"
#include "ui/main_window.h"
#include "ui/message_panel.h"
#include "ui/run_bar.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using testing::StandInSize;
using testing::TempDir;
using testing::waitFor;

// Frames that take long enough to be stopped among.
constexpr StandInSize kSlow{.cameras = 4, .frames = 6, .size_px = 448, .gaussians = 20000};

class WorkMenu : public ::testing::Test {
 protected:
  explicit WorkMenu(const StandInSize& size = {})
      : window(testing::standInServices(size), MainWindow::Layout::Fresh) {
    testing::holdStandInRuns(false);
    window.setAsksBeforeClosing(false);
    window.show();
  }
  bool open(const fs::path& path) {
    window.open(path);
    return settle();
  }
  bool settle() {
    return waitFor([&] { return window.model().isOpen() && window.settled(); });
  }
  void press(const char* command) { window.commands().action(command)->trigger(); }
  std::string refusal(const char* command) { return window.commands().refusalOf(command).toStdString(); }

  // Presses Report and answers where; the file that was proposed.
  QString pressReport(const QString& answer = {}) {
    QString proposed;
    QTimer timer;
    QObject::connect(&timer, &QTimer::timeout, [&] {
      auto* dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
      if (!dialog || dialog->selectedFiles().isEmpty()) return;
      timer.stop();
      proposed = dialog->selectedFiles().front();
      if (!answer.isEmpty()) dialog->findChild<QLineEdit*>()->setText(answer);
      for (auto* button : dialog->findChildren<QPushButton*>())
        if (button->text().remove("&") == "Save") return button->click();
    });
    timer.start(50);
    press("report");
    return proposed;
  }

  QStringList scoresShown() {
    QStringList words;
    for (const auto* label : window.findChild<QDockWidget*>("project")->findChildren<ElidedLabel*>())
      words << label->text();
    return words;
  }

  TempDir folder;
  MainWindow window;
};

TEST_F(WorkMenu, EvaluateShowsTheScoresOfHeldOutPhotographsAndKeepsThem) {
  testing::copySolvedStandIn(folder.path());
  ASSERT_TRUE(open(folder / "capture.beam"));
  EXPECT_TRUE(scoresShown().contains("None yet"));
  window.findChild<QDockWidget*>("project")->hide();
  press("evaluate");
  EXPECT_EQ(refusal("report"), "The evaluation is being made.");
  ASSERT_TRUE(settle());
  EXPECT_EQ(window.runBar().text().toStdString(), "The evaluation is ready");
  EXPECT_TRUE(scoresShown().contains("RGB, held out")) << scoresShown().join("; ").toStdString();
  EXPECT_TRUE(window.findChild<QDockWidget*>("project")->isVisible());
  EXPECT_NE(readTextFile(folder / "capture.beam" / kEvaluationFile).find("rgb_held_out"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "capture.beam" / kEvaluationFramesFile));
}

TEST_F(WorkMenu, ReportIsWrittenBesideTheProjectAndSaysWhere) {
  testing::copySolvedStandIn(folder.path());
  ASSERT_TRUE(open(folder / "capture.beam"));
  const QString page = pressReport();
  EXPECT_EQ(page.toStdString(), (folder / "capture-report.html").string());
  ASSERT_TRUE(settle());
  EXPECT_EQ(window.message().title().toStdString(), "The report is written");
  EXPECT_TRUE(window.message().text().contains(page)) << window.message().text().toStdString();
  EXPECT_NE(readTextFile(page.toStdString()).find("Quality report"), std::string::npos);
}

TEST_F(WorkMenu, AReportThatCannotBeWrittenIsSaid) {
  testing::copySolvedStandIn(folder.path());
  ASSERT_TRUE(open(folder / "capture.beam"));
  pressReport(QString::fromStdString((folder / "capture.beam" / "page.html").string()));
  ASSERT_TRUE(settle());
  EXPECT_EQ(window.runBar().text().toStdString(), "The report was not made");
  EXPECT_EQ(window.message().title().toStdString(), "The report was not made");
  EXPECT_TRUE(window.message().text().contains("page.html")) << window.message().text().toStdString();
  EXPECT_TRUE(window.message().text().contains("never written into"));
}

TEST_F(WorkMenu, NeitherCanBeDoneWithoutWhatItIsMadeOf) {
  EXPECT_EQ(refusal("evaluate"), "Open a capture or a project first.");
  EXPECT_EQ(refusal("report"), "Open a capture or a project first.");
  testing::newStandIn(folder.path());
  ASSERT_TRUE(open(folder / "capture.beam"));
  EXPECT_EQ(refusal("evaluate"), "No frame is solved yet: run one first.");
  EXPECT_EQ(refusal("report"), "No frame has a result yet: run one first.");
  testing::holdStandInRuns(true);
  window.run();
  EXPECT_EQ(refusal("evaluate"), "A run is going on: cancel it or wait for its end.");
  EXPECT_EQ(refusal("report"), "A run is going on: cancel it or wait for its end.");
  testing::holdStandInRuns(false);
  ASSERT_TRUE(waitFor([&] { return !window.job().busy() && window.settled(); }));
  EXPECT_EQ(refusal("evaluate"), "");
  EXPECT_EQ(refusal("report"), "");
  EXPECT_TRUE(window.commands().action("evaluate")->isEnabled());
}

TEST_F(WorkMenu, EvaluateNeedsAProjectThatCanBeWritten) {
  testing::copySolvedStandIn(folder.path());
  fs::permissions(folder / "capture.beam", fs::perms(0555));
  ASSERT_TRUE(open(folder / "capture.beam"));
  EXPECT_EQ(refusal("evaluate"), "The project is read-only: its scores could not be kept.");
  EXPECT_EQ(refusal("report"), "");
  fs::permissions(folder / "capture.beam", fs::perms(0755));
}

class WorkMenuWithoutTests : public WorkMenu {
 protected:
  WorkMenuWithoutTests() : WorkMenu({.held_out = 0, .frames = 1}) {}
};

TEST_F(WorkMenuWithoutTests, EvaluateNeedsAHeldOutCamera) {
  testing::solvedStandIn(folder.path(), {.held_out = 0, .frames = 1});
  ASSERT_TRUE(open(folder / "capture.beam"));
  EXPECT_TRUE(refusal("evaluate").starts_with("No held-out camera has photographs"));
  EXPECT_EQ(refusal("report"), "");
}

class SlowWorkMenu : public WorkMenu {
 protected:
  SlowWorkMenu() : WorkMenu(kSlow) { testing::solvedStandIn(folder.path(), kSlow); }
  // Once it tells how far it is.
  bool cancelInTheMiddle() {
    const bool begun = waitFor([&] { return window.runBar().text().contains(": "); });
    window.cancelRun();
    return begun && settle();
  }
};

TEST_F(SlowWorkMenu, EvaluateIsCancelledAndLeavesNothing) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  press("evaluate");
  ASSERT_TRUE(cancelInTheMiddle());
  EXPECT_EQ(window.runBar().text().toStdString(), "Cancelled");
  EXPECT_FALSE(fs::exists(folder / "capture.beam" / kEvaluationFile));
}

TEST_F(SlowWorkMenu, ReportIsCancelledAndLeavesNothing) {
  ASSERT_TRUE(open(folder / "capture.beam"));
  const QString page = pressReport();
  ASSERT_TRUE(cancelInTheMiddle());
  EXPECT_EQ(window.runBar().text().toStdString(), "Cancelled");
  EXPECT_FALSE(fs::exists(page.toStdString()));
}

}  // namespace
}  // namespace beam
