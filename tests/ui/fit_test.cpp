// SPDX-License-Identifier: Apache-2.0
// Everything has its place, from the smallest window to the largest, with letters of one size and a half,
// too. The scale of the screen is QT_SCALE_FACTOR's: one process each.
#include <gtest/gtest.h>

#include <QApplication>
#include <QDockWidget>
#include <QScreen>
#include <QSettings>
#include <QSurfaceFormat>
#include <QTabBar>
#include <QToolButton>
#include <QtTest/QTest>

#include <cstdlib>
#include <functional>
#include <map>

#include "tests/support/painted_text.h"
#include "tests/support/stand_in_studio.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "tests/support/window_fit.h"
#include "tests/support/window_look.h"
#include "ui/main_window.h"
#include "ui/stage_rail.h"
#include "ui/theme.h"
#include "ui/timeline_lanes.h"
#include "ui/timeline_panel.h"
#include "viewers/gl/functions.h"

namespace beam {
namespace {

using namespace testing;

constexpr QSize kSizes[] = {{1000, 680},  {1024, 700},  {1280, 720},  {1366, 768},
                            {1600, 1000}, {1920, 1080}, {2560, 1440}, {3840, 2160}};
constexpr QSize kScreen{3840, 2160};  // in its own pixels: no larger window can be there
constexpr int kTitleBar_px = 30;      // about what a window manager adds

// A fault and where it was seen.
using Faults = std::map<QString, QStringList>;

void report(const Faults& faults) {
  for (const auto& [fault, places] : faults)
    ADD_FAILURE() << fault.toStdString() << "\n    " << places.size() << " times, first "
                  << places.front().toStdString();
}

QTabBar* barWith(const QWidget& window, const QString& tab, int& index) {
  for (QTabBar* bar : window.findChildren<QTabBar*>()) {
    for (int i = 0; i < bar->count(); ++i) {
      index = i;
      if (bar->isVisible() && plainText(bar->tabText(i)).startsWith(tab)) return bar;  // a count may follow
    }
  }
  return nullptr;
}

void chooseTab(const QWidget& window, const QString& tab) {
  int index = 0;
  QTabBar* bar = barWith(window, tab, index);
  ASSERT_TRUE(bar) << "there is no tab " << tab.toStdString();
  bar->setCurrentIndex(index);
}

class Fit : public ::testing::Test {
 protected:
  Fit() {
    copySolvedStandIn(folder_.path());
    font_ = QApplication::font();
  }
  ~Fit() override {
    holdStandInRuns(false);
    QApplication::setFont(font_);
  }

  // A window, opened or with the start page, at all sizes in every arrangement.
  void lookAll(double letters, bool open) {
    QFont font = font_;
    font.setPixelSize(static_cast<int>(std::lround(letters * QFontInfo(font_).pixelSize())));
    QApplication::setFont(font);
    MainWindow window(standInServices(), MainWindow::Layout::Fresh);
    window.show();
    letters_ = letters;
    if (!open) {
      look(window, "start page");
    } else {
      window.open(folder_ / "capture.beam");
      ASSERT_TRUE(waitFor([&] { return window.model().isOpen() && window.settled(); }));
      lookOpen(window);
    }
    report(faults_);
  }

  TempDir folder_;

 private:
  void lookOpen(MainWindow& window) {
    for (const char* tab : {"Splats", "Images", "Scene", "Display"}) {
      chooseTab(window, tab);
      look(window, tab);
    }
    chooseTab(window, "Settings");
    for (const StageInfo& stage : window.model().project().setup().stages.infos()) {
      window.rail().select(stage.id);
      for (auto* fold : window.findChildren<QToolButton*>()) {
        if (fold->isVisible() && fold->text().startsWith("Advanced") && fold->arrowType() == Qt::RightArrow)
          fold->click();
      }
      look(window, "settings of " + QString::fromStdString(stage.id));
    }
    chooseTab(window, "Log");
    look(window, "log");
    chooseTab(window, "Timeline");
    for (auto* dock : window.findChildren<QDockWidget*>("timeline")) dock->hide();
    look(window, "without the timeline");
    for (auto* dock : window.findChildren<QDockWidget*>("timeline")) dock->show();
    holdStandInRuns(true);
    window.model().set("surface.iterations", FieldValue(7));
    window.run();
    ASSERT_TRUE(waitFor([&] { return window.job().busy(); }));
    QTest::qWait(200);
    look(window, "a run");
    window.open(folder_ / "nowhere");
    QTest::qWait(100);
    look(window, "a message");
  }

  void look(MainWindow& window, const QString& what) {
    window.setUpdatesEnabled(false);  // places are looked at, not pictures
    for (const QSize& size : kSizes) {
      if (size.width() * window.devicePixelRatioF() > kScreen.width()) continue;
      window.resize(size);
      QApplication::processEvents();
      QApplication::processEvents();  // what a layout asks of the one around it
      const QString where =
          QString("in %1x%2, letters x%3, %4").arg(size.width()).arg(size.height()).arg(letters_).arg(what);
      if (window.size() != size)
        faults_["the window cannot be made that small"]
            << where + QString(": it is %1x%2").arg(window.width()).arg(window.height());
      QStringList faults = faultsOfFit(window);
      if (!faults.isEmpty()) {
        QTest::qWait(40);  // words that have just changed get their room with the next layout
        faults = faultsOfFit(window);
      }
      for (const QString& fault : faults)
        faults_[fault.section('\t', 0, 0)] << where + ": " + fault.section('\t', 1);
    }
    window.setUpdatesEnabled(true);
  }

  QFont font_;
  double letters_ = 1;
  Faults faults_;
};

TEST_F(Fit, TheStartPageHasRoomForEverything) { lookAll(1, false); }
TEST_F(Fit, TheStartPageHasRoomForLargeLetters) { lookAll(1.5, false); }
TEST_F(Fit, TheOpenWindowHasRoomForEverything) { lookAll(1, true); }
TEST_F(Fit, TheOpenWindowHasRoomForLargeLetters) { lookAll(1.5, true); }

TEST_F(Fit, NamesOfTheTimelineAreWholeInLargeLetters) {
  applyTheme(*qApp, Theme::Dark, 1.5);
  {
    MainWindow window(standInServices(), MainWindow::Layout::Fresh);
    window.resize(1600, 1000);
    window.show();
    window.open(folder_ / "capture.beam");
    ASSERT_TRUE(waitFor([&] { return window.model().isOpen() && window.settled(); }));
    for (const PaintedText& text : paintedTexts(window.timeline().lanes()))
      EXPECT_FALSE(text.text.endsWith("…")) << text.text.toStdString();
  }
  applyTheme(*qApp);
}

TEST(SmallScreen, TheWindowOpensInsideOfIt) {
  MainWindow window(standInServices(), MainWindow::Layout::Fresh);
  window.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&window));
  const QRect room = QGuiApplication::primaryScreen()->availableGeometry();
  ASSERT_LT(room.width(), 1600) << "this test wants a small screen";
  EXPECT_LE(window.width(), room.width());
  EXPECT_LE(window.height(), room.height() - kTitleBar_px);
  EXPECT_TRUE(room.contains(window.geometry()))
      << window.x() << "," << window.y() << " " << window.width() << "x" << window.height();
  for (const auto* dock : window.findChildren<QDockWidget*>()) {
    if (!dock->visibleRegion().isEmpty()) {
      EXPECT_TRUE(room.contains(QRect(dock->mapToGlobal(QPoint()), dock->size())))
          << dock->windowTitle().toStdString();
    }
  }
}

}  // namespace
}  // namespace beam

// The window's own main: settings of this test alone.
int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  QSurfaceFormat::setDefaultFormat(beam::surfaceFormat());
  QApplication application(argc, argv);
  const beam::testing::TempDir settings;
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path().c_str());
  QApplication::setOrganizationName("BEAM Studio test");
  QApplication::setApplicationName("fit");
  beam::applyTheme(application);
  return RUN_ALL_TESTS();
}
