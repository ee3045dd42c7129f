// SPDX-License-Identifier: Apache-2.0
// The image page and the display panel: choices that outlive frames without a picture, comparing, limits,
// room for the words, and keys that are left to the window.
#include <gtest/gtest.h>

#include <QApplication>
#include <QCheckBox>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QScrollArea>
#include <QScrollBar>
#include <QSlider>
#include <QToolButton>
#include <QVBoxLayout>

#include <atomic>

#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/pipeline/project.h"
#include "core/render/cpu_scene_renderer.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "ui/display_panel.h"
#include "ui/image_page.h"
#include "ui/quiet_combo.h"
#include "viewers/image/image_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using testing::TempDir;
using testing::waitFor;

std::atomic<int> g_photos_read{0};

// The second camera has no photograph of the second frame.
class PatchySource final : public FrameSource {
 public:
  explicit PatchySource(std::vector<FrameView> views) : views_(std::move(views)) {}
  bool has(ViewIndex view, FrameIndex frame) const override { return view.value != 1 || frame.value == 0; }
  Image<u8vec3> photo(ViewIndex view, FrameIndex) const override {
    ++g_photos_read;
    return views_[view.value].photo;
  }
  Image<std::uint8_t> mask(ViewIndex view, FrameIndex) const override { return views_[view.value].mask; }

 private:
  std::vector<FrameView> views_;
};

ImportedCapture patchyCapture(const fs::path&, const ImportOptions&) {
  const std::vector<FrameView> views = testing::photographs({.cameras = 3});
  ImportedCapture imported;
  imported.set.name = "patchy";
  for (const FrameView& view : views) imported.set.views.push_back({view.name, view.camera, Split::Train});
  imported.set.frames = {"000000", "000001"};
  imported.set.masks = MaskKind::Files;
  imported.set.source = std::make_shared<PatchySource>(views);
  imported.layout = "memory";
  return imported;
}

StudioServices patchyServices() {
  auto setup = std::make_shared<PipelineSetup>();
  setup->presets = "";
  setup->open_capture = patchyCapture;
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  return {.pipeline = setup,
          .job_device = device,
          .new_renderer = cpuSceneRenderers(device),
          .make_sample = {},
          .version = "test"};
}

class Page : public ::testing::Test {
 protected:
  Page() {
    fs::create_directory(folder / "capture");
    model.open(folder / "capture");
    EXPECT_TRUE(waitFor([&] { return model.isOpen() && model.settled(); }));
    page.resize(900, 500);
    page.show();
    page.refresh();
  }
  bool settle() {
    return waitFor([&] { return page.view().settled(); });
  }
  QToolButton* button(const QString& text) {
    for (QToolButton* b : page.findChildren<QToolButton*>()) {
      if (b->text() == text) return b;
    }
    return nullptr;
  }
  // Camera, A, B.
  QuietCombo* combo(int i) { return page.findChildren<QuietCombo*>()[i]; }

  TempDir folder;
  ProjectModel model{patchyServices()};
  ImagePage page{model};
};

TEST_F(Page, SaysThatACameraHasNoPhotographOfTheFrameAndKeepsTheChoice) {
  page.choose(ViewIndex{1});
  ASSERT_TRUE(settle());
  EXPECT_EQ(page.view().note(0), "");
  model.setFrame(FrameIndex{1});
  ASSERT_TRUE(waitFor([&] { return model.settled(); }));
  page.refresh();
  ASSERT_TRUE(settle());
  EXPECT_EQ(page.view().note(0), "camera cam1 has no photograph of frame 000001");
  EXPECT_EQ(combo(1)->currentText(), "Photograph");
  page.choosePictures("render.normal", "");
  ASSERT_TRUE(settle());
  EXPECT_TRUE(page.view().note(0).contains("frame 000001 is not solved"))
      << page.view().note(0).toStdString();
  EXPECT_EQ(combo(1)->currentText(), "Rendered: Normal");
  page.choosePictures("photo", "");
  page.choose(ViewIndex{0});
  ASSERT_TRUE(settle());
  EXPECT_EQ(page.view().note(0), "");
}

TEST_F(Page, ComparesWithTheRenderWhereNothingWasChosen) {
  for (const QString& text : {QString("Difference"), QString("Wipe")}) {
    page.choosePictures("photo", "");
    ASSERT_NE(button(text), nullptr);
    EXPECT_TRUE(button(text)->isEnabled());
    button(text)->click();
    EXPECT_EQ(combo(2)->currentText(), "Rendered: Colour") << text.toStdString();
    EXPECT_TRUE(button(text)->isChecked());
  }
  EXPECT_FALSE(button("Difference")->isChecked()) << "they take turns";
  page.choosePictures("render.rgb", "");
  QKeyEvent d(QEvent::KeyPress, Qt::Key_D, Qt::NoModifier);
  QApplication::sendEvent(&page.view(), &d);
  EXPECT_EQ(combo(2)->currentText(), "Photograph") << "a picture with itself tells nothing";
}

TEST_F(Page, HoldsTheLimitsThatAreTyped) {
  page.choosePictures("photo", "mask");
  page.choosePictures("mask", "mask");
  button("Difference")->click();
  ASSERT_TRUE(settle());
  auto* lock = page.findChild<QCheckBox*>();
  const QList<QLineEdit*> fields = page.findChildren<QLineEdit*>();
  ASSERT_EQ(fields.size(), 2);
  EXPECT_TRUE(lock->isEnabled());
  EXPECT_FALSE(fields[1]->isEnabled());
  EXPECT_FALSE(fields[1]->toolTip().isEmpty()) << "says why";
  lock->click();
  ASSERT_TRUE(settle());
  const auto type = [](QLineEdit* field, const QString& text) {
    field->setText(text);
    field->setModified(true);
    Q_EMIT field->editingFinished();
  };
  type(fields[1], "0.25");
  ASSERT_TRUE(settle());
  EXPECT_EQ(page.view().legend().limits.high, 0.25f);
  type(fields[1], "abc");
  EXPECT_TRUE(fields[1]->property("wrong").toBool());
  EXPECT_EQ(fields[1]->text(), "abc") << "what is typed stays to be mended";
  EXPECT_EQ(page.view().legend().limits.high, 0.25f);
  type(fields[1], "-1");
  EXPECT_TRUE(fields[1]->property("wrong").toBool()) << "below the low one";
  type(fields[1], "0.5");
  ASSERT_TRUE(settle());
  EXPECT_FALSE(fields[1]->property("wrong").toBool());
  page.choose(ViewIndex{2});
  ASSERT_TRUE(settle());
  EXPECT_EQ(page.view().legend().limits.high, 0.5f) << "another camera, the same limits";
  lock->click();
  ASSERT_TRUE(settle());
  EXPECT_FALSE(page.view().legend().locked);
}

TEST_F(Page, ReadsAgainOnlyWhatChanged) {
  page.choosePictures("photo", "");
  ASSERT_TRUE(settle());
  const int read = g_photos_read;
  for (int i = 0; i < 3; ++i) page.refresh();
  page.setLight({nullptr, 1.0f, true});
  ASSERT_TRUE(settle());
  EXPECT_EQ(g_photos_read, read);
  page.choose(ViewIndex{2});
  ASSERT_TRUE(settle());
  EXPECT_EQ(g_photos_read, read + 1);
}

TEST_F(Page, SaysThatTheLightIsBeingRead) {
  page.setLight({nullptr, 0, true});
  page.choosePictures("render.relight", "");
  ASSERT_TRUE(settle());
  EXPECT_TRUE(page.view().note(0).contains("not solved")) << page.view().note(0).toStdString();
}

TEST_F(Page, ForgetsWhatBelongedToTheProjectBefore) {
  page.choosePictures("mask", "photo");
  page.choose(ViewIndex{2});
  page.view().setExposure(2);
  page.reset();
  ASSERT_TRUE(settle());
  EXPECT_EQ(combo(0)->currentIndex(), 0);
  EXPECT_EQ(combo(1)->currentText(), "Photograph");
  EXPECT_EQ(combo(2)->currentText(), "none");
  EXPECT_FALSE(page.view().wipe());
  EXPECT_EQ(page.view().exposure(), 0);
}

TEST(EmptyPage, RefusesWithAReason) {
  const ProjectModel model{patchyServices()};
  ImagePage page(model);
  page.show();
  int refused = 0;
  for (QWidget* w : page.findChildren<QWidget*>()) {
    const bool control = qobject_cast<QToolButton*>(w) || qobject_cast<QuietCombo*>(w) ||
                         qobject_cast<QCheckBox*>(w) || qobject_cast<QLineEdit*>(w);
    if (!control) continue;
    EXPECT_FALSE(w->isEnabled());
    EXPECT_FALSE(w->toolTip().isEmpty());
    ++refused;
  }
  EXPECT_EQ(refused, 8);
}

// Nothing beside another lies over it or outside of its parent, and no label is cut.
void expectFits(const QWidget& parent) {
  std::vector<const QWidget*> children;
  for (const QObject* child : parent.children()) {
    const auto* w = qobject_cast<const QWidget*>(child);
    if (w != nullptr && w->isVisible() && !w->isWindow()) children.push_back(w);
  }
  const auto name = [](const QWidget* w) {
    const auto* label = qobject_cast<const QLabel*>(w);
    const auto* press = qobject_cast<const QAbstractButton*>(w);
    return std::string(w->metaObject()->className()) + " " +
           (label   ? label->text()
            : press ? press->text()
                    : QString())
               .toStdString();
  };
  // What is under a scroll bar may be longer than its window, not wider.
  const bool scrolls = qobject_cast<const QAbstractScrollArea*>(parent.parentWidget()) != nullptr;
  for (const QWidget* w : children) {
    EXPECT_LE(w->width(), parent.width()) << name(w);
    EXPECT_TRUE(scrolls || parent.rect().contains(w->geometry())) << name(w);
    for (const QWidget* other : children)
      EXPECT_TRUE(w == other || !w->geometry().intersects(other->geometry()))
          << name(w) << " / " << name(other);
    const auto* label = qobject_cast<const QLabel*>(w);
    const bool whole = label == nullptr || label->wordWrap();
    EXPECT_TRUE(whole || w->width() >= label->fontMetrics().horizontalAdvance(label->text())) << name(w);
    const bool presses = qobject_cast<const QAbstractButton*>(w) != nullptr;
    EXPECT_TRUE(!presses || w->width() >= w->minimumSizeHint().width()) << name(w);
    expectFits(*w);
  }
}

QFont largeFont() {
  QFont font = QApplication::font();
  font.setPointSizeF(1.5 * font.pointSizeF());
  return font;
}

TEST_F(Page, FitsWithLargeTypeAt480Pixels) {
  page.setFont(largeFont());
  for (const int width : {480, 640, 800, 1400}) {
    page.resize(width, 500);
    QApplication::processEvents();
    EXPECT_EQ(page.width(), width) << "it may become that narrow";
    expectFits(page);
  }
}

class Panel : public ::testing::Test {
 protected:
  Panel() { panel.show(); }
  SplatView view{cpuSceneRenderers(makeCpuDevice())};
  LightLibrary lights;
  DisplayPanel panel{view, lights};
};

TEST_F(Panel, FitsWithLargeTypeAt240Pixels) {
  panel.setFont(largeFont());
  for (const int width : {240, 340}) {
    panel.resize(width, 400);
    view.setExposure(-6);
    view.setYaw(-3.1f);
    QApplication::processEvents();
    EXPECT_EQ(panel.width(), width);
    expectFits(panel);
    EXPECT_LE(panel.findChild<QScrollArea*>()->widget()->minimumSizeHint().width(),
              panel.findChild<QScrollArea*>()->viewport()->width())
        << "the words beside the bar are not cut";
  }
}

TEST_F(Panel, TellsUnitsAndWhyWhatIsGreyIsGrey) {
  view.setExposure(0.5f);
  QStringList texts;
  for (const QLabel* label : panel.findChildren<QLabel*>()) texts << label->text();
  EXPECT_TRUE(texts.contains("+0.50 stops"));
  int grey = 0;
  for (const QWidget* w : panel.findChildren<QWidget*>()) {
    if (w->isEnabledTo(&panel) || w->focusPolicy() == Qt::NoFocus || qobject_cast<const QScrollBar*>(w))
      continue;
    EXPECT_FALSE(w->toolTip().isEmpty()) << w->metaObject()->className();
    ++grey;
  }
  EXPECT_EQ(grey, 5) << "light, turn, photograph, sky and the limits of depth";
}

TEST_F(Panel, IsReachedByTabEverywhere) {
  for (const QWidget* w : panel.findChildren<QWidget*>()) {
    const bool control = qobject_cast<const QSlider*>(w) || qobject_cast<const QuietCombo*>(w) ||
                         qobject_cast<const QAbstractButton*>(w);
    EXPECT_TRUE(!control || !w->isVisible() || (w->focusPolicy() & Qt::TabFocus))
        << w->metaObject()->className();
  }
}

TEST(Lights, AreBeingReadUntilTheyAreThere) {
  const TempDir folder;
  writeExr(folder / "sky.exr", Planes(32, 16, 3, 1.0f), {"R", "G", "B"}, ExrPrecision::Half);
  LightLibrary lights;
  EXPECT_FALSE(lights.reading());
  std::vector<bool> heard;
  QObject::connect(&lights, &LightLibrary::lightChanged, &lights, [&] { heard.push_back(lights.reading()); });
  lights.reset(folder / "sky.exr");
  EXPECT_TRUE(lights.reading());
  EXPECT_EQ(lights.light(), nullptr);
  ASSERT_TRUE(waitFor([&] { return lights.settled(); }));
  EXPECT_FALSE(lights.reading());
  EXPECT_NE(lights.light(), nullptr);
  EXPECT_EQ(heard, std::vector<bool>({true, false})) << "the window is told of both";
  lights.reset({});
  EXPECT_FALSE(lights.reading());
}

TEST(Lights, StayWhereAnotherCannotBeRead) {
  const TempDir folder;
  writeExr(folder / "sky.exr", Planes(32, 16, 3, 1.0f), {"R", "G", "B"}, ExrPrecision::Half);
  writeFileAtomically(folder / "bad.exr", "no panorama");
  LightLibrary lights;
  QString why;
  QObject::connect(&lights, &LightLibrary::failed, &lights,
                   [&](const QString&, const QString& words) { why = words; });
  lights.reset(folder / "sky.exr");
  ASSERT_TRUE(waitFor([&] { return lights.settled(); }));
  lights.add(folder / "bad.exr");
  ASSERT_TRUE(waitFor([&] { return lights.settled(); }));
  EXPECT_FALSE(why.isEmpty());
  EXPECT_EQ(lights.chosen(), 0);
  EXPECT_NE(lights.light(), nullptr);
  EXPECT_EQ(lights.entries().size(), 1u);
}

// What a widget lets pass arrives at its parent.
class KeyCounter final : public QWidget {
 public:
  QList<int> keys;

 protected:
  void keyPressEvent(QKeyEvent* event) override { keys << event->key(); }
};

TEST(QuietControls, LeaveLettersAndDigitsToTheWindow) {
  KeyCounter window;
  auto* column = new QVBoxLayout(&window);
  auto* combo = new QuietCombo;
  combo->addItems({"1   Relit", "2   Colour", "Exposure"});
  auto* slider = new QSlider(Qt::Horizontal);
  auto* check = new QCheckBox("Sky");
  for (QWidget* w : std::initializer_list<QWidget*>{combo, slider, check}) column->addWidget(w);
  window.show();
  const auto type = [](QWidget* w, int key, const QString& text) {
    QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier, text);
    QApplication::sendEvent(w, &event);
  };
  for (QWidget* w : std::initializer_list<QWidget*>{combo, slider, check}) {
    window.keys.clear();
    type(w, Qt::Key_2, "2");
    type(w, Qt::Key_E, "e");
    type(w, Qt::Key_BracketLeft, "[");
    EXPECT_EQ(window.keys, QList<int>({Qt::Key_2, Qt::Key_E, Qt::Key_BracketLeft}))
        << w->metaObject()->className();
  }
  EXPECT_EQ(combo->currentIndex(), 0);
  type(combo, Qt::Key_Down, {});
  EXPECT_EQ(combo->currentIndex(), 1) << "its own keys stay its own";
}

TEST(QuietControls, TellInTheTooltipWhatIsCut) {
  QuietCombo combo;
  combo.setHelp("The light");
  combo.addItem("a panorama with a name that is much longer than the box");
  combo.resize(90, 28);
  combo.show();
  QApplication::processEvents();
  EXPECT_TRUE(combo.toolTip().contains(combo.currentText()));
  EXPECT_TRUE(combo.toolTip().startsWith("The light"));
  combo.resize(1200, 28);
  QApplication::processEvents();
  EXPECT_EQ(combo.toolTip(), "The light");
}

}  // namespace
}  // namespace beam
