// SPDX-License-Identifier: Apache-2.0
// Whoever walks through the window by Tab sees where he is: every stop shows that it has the focus.
#include <gtest/gtest.h>

#include <QApplication>
#include <QtTest/QTest>

#include "tests/support/stand_in_studio.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "tests/support/window_look.h"
#include "ui/main_window.h"
#include "ui/theme.h"

namespace beam {
namespace {

using namespace testing;

constexpr int kMostStops = 150, kLeastPixels = 40;

// Of the place where the widget is, with what is around it.
QImage pictureOf(QWidget& window, const QWidget& widget) {
  QTest::qWait(20);
  const QRect place(widget.mapTo(&window, QPoint()), widget.size());
  return window.grab(place).toImage().convertToFormat(QImage::Format_RGB32);
}

int differingPixels(const QImage& a, const QImage& b) {
  int differing = 0;
  for (int y = 0; y < std::min(a.height(), b.height()); ++y) {
    for (int x = 0; x < std::min(a.width(), b.width()); ++x) differing += a.pixel(x, y) != b.pixel(x, y);
  }
  return differing;
}

class Focus : public ::testing::Test {
 protected:
  Focus() {
    applyTheme(*qApp);
    copySolvedStandIn(folder.path());
    window = std::make_unique<MainWindow>(standInServices(), MainWindow::Layout::Fresh);
    window->resize(1600, 1000);
    window->show();
    window->open(folder / "capture.beam");
    EXPECT_TRUE(waitFor([&] { return window->model().isOpen() && window->settled(); }));
    QApplication::setActiveWindow(window.get());
  }
  ~Focus() override { qApp->setStyleSheet({}); }

  TempDir folder;
  std::unique_ptr<MainWindow> window;
};

TEST_F(Focus, EveryTabStopShowsThatItHasTheFocus) {
  for (const StudioView view : {StudioView::Splat, StudioView::Image, StudioView::Scene}) {
    window->showView(view);
    ASSERT_TRUE(waitFor([&] { return window->settled(); }));
    std::set<QWidget*> seen;
    for (int i = 0; i < kMostStops; ++i) {
      QTest::keyClick(QApplication::focusWidget(), Qt::Key_Tab);
      QWidget* const stop = QApplication::focusWidget();
      ASSERT_NE(stop, nullptr);
      if (!seen.insert(stop).second) break;
      const QImage with = pictureOf(*window, *stop);
      stop->clearFocus();
      const QImage without = pictureOf(*window, *stop);
      stop->setFocus(Qt::TabFocusReason);
      EXPECT_GT(differingPixels(with, without), kLeastPixels) << pathOf(*stop).toStdString();
    }
    EXPECT_GT(seen.size(), 15u);
  }
}

}  // namespace
}  // namespace beam
