// SPDX-License-Identifier: Apache-2.0
// The panel Display speaks of the view that is seen: what that does not use is grey and says why.
#include <gtest/gtest.h>

#include <QApplication>
#include <QCheckBox>
#include <QLabel>
#include <QSlider>
#include <QtTest/QTest>

#include "tests/support/stand_in_studio.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "ui/display_panel.h"
#include "ui/image_page.h"
#include "ui/main_window.h"
#include "viewers/image/image_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

using namespace testing;

class Display : public ::testing::Test {
 protected:
  Display() {
    copySolvedStandIn(folder.path());
    window = std::make_unique<MainWindow>(standInServices(), MainWindow::Layout::Fresh);
    window->resize(1600, 1000);
    window->show();
    window->open(folder / "capture.beam");
    EXPECT_TRUE(waitFor([&] { return window->model().isOpen() && window->settled(); }));
    panel = window->findChild<DisplayPanel*>();
  }
  // By the words of its label.
  QWidget* control(const QString& name) {
    for (const QLabel* label : panel->findChildren<QLabel*>()) {
      if (label->text() == name) return label->buddy();
    }
    for (QCheckBox* box : panel->findChildren<QCheckBox*>()) {
      if (box->text() == name) return box;
    }
    return nullptr;
  }
  QString allWords() {
    QString words;
    for (const QLabel* label : panel->findChildren<QLabel*>()) words += label->text() + "\n";
    return words;
  }

  TempDir folder;
  std::unique_ptr<MainWindow> window;
  DisplayPanel* panel = nullptr;
};

TEST_F(Display, GreysWhatTheViewDoesNotUseAndSaysWhy) {
  const std::map<StudioView, QStringList> grey{
      {StudioView::Splat, {"Photograph"}},
      {StudioView::Image, {"Channel", "Photograph", "Show panorama", "Lock depth limits"}},
      {StudioView::Scene,
       {"Channel", "Light", "Turn of light", "Exposure", "Photograph", "Show panorama",
        "Lock depth limits"}}};
  for (const auto& [view, names] : grey) {
    window->showView(view);
    for (const QString& name : names) {
      ASSERT_TRUE(control(name)) << name.toStdString();
      EXPECT_FALSE(control(name)->isEnabled()) << name.toStdString();
      EXPECT_TRUE(control(name)->toolTip().contains(view == StudioView::Splat   ? "[ and ]"
                                                    : view == StudioView::Image ? "The view Images shows"
                                                                                : "The view Scene shows"))
          << control(name)->toolTip().toStdString();
    }
  }
  window->showView(StudioView::Splat);
  window->splatView().lookThrough(ViewIndex{0});
  EXPECT_TRUE(control("Photograph")->isEnabled());
}

TEST_F(Display, SpeaksOfTheHandsOfTheViewThatIsSeen) {
  EXPECT_TRUE(allWords().contains("orbits"));
  window->showView(StudioView::Image);
  EXPECT_FALSE(allWords().contains("orbits"));
  EXPECT_TRUE(allWords().contains("wipes"));
  window->showView(StudioView::Scene);
  EXPECT_TRUE(allWords().contains("joints"));
}

TEST_F(Display, ExposesPicturesAsTheSplatsByHandAndByKey) {
  window->showView(StudioView::Image);
  auto& slider = *qobject_cast<QSlider*>(control("Exposure"));
  ImageView& pictures = window->imagePage().view();
  ASSERT_TRUE(slider.isEnabled());
  slider.setValue(4);
  EXPECT_EQ(pictures.exposure(), 1);
  QTest::keyClick(&pictures, Qt::Key_E);
  EXPECT_EQ(slider.value(), 6);
  QTest::keyClick(&pictures, Qt::Key_R);
  EXPECT_EQ(slider.value(), 0);
  EXPECT_EQ(pictures.exposure(), 0);
  window->showView(StudioView::Splat);
  window->splatView().setExposure(2);
  window->showView(StudioView::Image);
  EXPECT_EQ(pictures.exposure(), 2);
}

}  // namespace
}  // namespace beam
