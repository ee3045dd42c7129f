// SPDX-License-Identifier: Apache-2.0
// The panels beside the views: cameras, problems, log, message, timeline row; and the look that they share.
#include <gtest/gtest.h>

#include <QApplication>
#include <QClipboard>
#include <QComboBox>
#include <QFile>
#include <QKeyEvent>
#include <QLabel>
#include <QListWidget>
#include <QMouseEvent>
#include <QScrollArea>
#include <QScrollBar>
#include <QTextBlock>
#include <QToolButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include <algorithm>

#include "core/render/cpu_scene_renderer.h"
#include "core/render/device.h"
#include "core/scene/transform.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "ui/elided_label.h"
#include "ui/log_panel.h"
#include "ui/message_panel.h"
#include "ui/problem_list.h"
#include "ui/project_panel.h"
#include "ui/theme.h"
#include "ui/timeline_panel.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using testing::TempDir;
using testing::waitFor;

class NoPictures final : public FrameSource {
 public:
  bool has(ViewIndex, FrameIndex) const override { return false; }
  Image<u8vec3> photo(ViewIndex, FrameIndex) const override { return {}; }
  Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return {}; }
};

ImportedCapture threeCameras(const fs::path&, const ImportOptions&) {
  ImportedCapture imported;
  imported.set.name = "a-capture-with-a-name-that-is-much-longer-than-any-panel-is-wide";
  for (const char* name : {"C01", "C02", "C03"})
    imported.set.views.push_back({name, {{300, 300, 100, 100}, 200, 200, {}}, Split::Train});
  imported.set.frames = {"000000", "000001", "000002"};
  imported.set.frames_per_second = 25;
  imported.set.source = std::make_shared<NoPictures>();
  imported.layout = "memory";
  return imported;
}

class Panels : public ::testing::Test {
 protected:
  Panels() : model(services()) {
    fs::create_directory(folder / "capture");
    model.open(folder / "capture");
    EXPECT_TRUE(waitFor([&] { return model.isOpen() && model.settled(); }));
  }
  static StudioServices services() {
    auto setup = std::make_shared<PipelineSetup>();
    setup->open_capture = threeCameras;
    const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
    return {.pipeline = setup,
            .job_device = device,
            .new_renderer = cpuSceneRenderers(device),
            .make_sample = {},
            .version = "test"};
  }
  ~Panels() override { application().setStyleSheet({}); }
  static QApplication& application() { return *static_cast<QApplication*>(QCoreApplication::instance()); }
  // In a window of this size, with text so many times as large.
  void show(QWidget& panel, int width, int height, double scale) {
    applyTheme(application(), Theme::Dark, scale);
    if (!window.layout()) new QVBoxLayout(&window);
    window.layout()->setContentsMargins(0, 0, 0, 0);
    window.layout()->addWidget(&panel);
    window.resize(width, height);
    window.show();
    QApplication::processEvents();
  }

  TempDir folder;
  ProjectModel model;
  QWidget window;
};

bool says(const QWidget& panel, const QString& words) {
  const QList<QLabel*> labels = panel.findChildren<QLabel*>();
  return std::any_of(labels.begin(), labels.end(),
                     [&](const QLabel* l) { return l->text().contains(words); });
}

TEST_F(Panels, TheProjectSaysWhatItsCaptureWasTakenForWhereItIsMoreThanTurned) {
  ProjectPanel metres(model);
  EXPECT_FALSE(says(metres, "taken as"));
  StudioServices with = services();
  auto setup = std::make_shared<PipelineSetup>();
  setup->open_capture = [](const fs::path& capture, const ImportOptions& options) {
    ImportedCapture imported = threeCameras(capture, options);
    imported.placement = {0.001, dvec3(0), UnitFrom::Height, 1712};
    imported.set = transformed(std::move(imported.set), worldFromCapture(UpAxis::PlusY, imported.placement));
    return imported;
  };
  with.pipeline = setup;
  ProjectModel scaled(with);
  fs::create_directory(folder / "millimetres");
  scaled.open(folder / "millimetres");
  ASSERT_TRUE(waitFor([&] { return scaled.isOpen() && scaled.settled(); }));
  ProjectPanel millimetres(scaled);
  EXPECT_TRUE(says(millimetres, "The subject is 1,712 units tall: taken as millimetres"));
}

struct Cameras {
  explicit Cameras(ProjectPanel& panel) : tree(panel.cameras()) {
    QObject::connect(&panel, &ProjectPanel::cameraChosen, &panel,
                     [this](ViewIndex v) { told << "choose" + QString::number(v.value); });
    QObject::connect(&panel, &ProjectPanel::cameraActivated, &panel,
                     [this](ViewIndex v) { told << "look" + QString::number(v.value); });
  }
  QTreeWidgetItem* row(int i) { return tree.topLevelItem(0)->child(i); }
  void mouse(QEvent::Type type, int i) {
    const QPointF at = tree.visualItemRect(row(i)).center();
    QMouseEvent event(type, at, tree.viewport()->mapToGlobal(at.toPoint()), Qt::LeftButton,
                      type == QEvent::MouseButtonRelease ? Qt::NoButton : Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(tree.viewport(), &event);
  }
  void click(int i) {
    mouse(QEvent::MouseButtonPress, i);
    mouse(QEvent::MouseButtonRelease, i);
  }
  void key(int code, const QString& text = {}) {
    QKeyEvent event(QEvent::KeyPress, code, Qt::NoModifier, text);
    QApplication::sendEvent(&tree, &event);
  }

  QTreeWidget& tree;
  QStringList told;
};

TEST_F(Panels, AClickChoosesACameraADoubleClickOrEnterLooksThroughIt) {
  ProjectPanel panel(model);
  show(panel, 300, 700, 1);
  Cameras cameras(panel);
  cameras.click(1);
  EXPECT_EQ(cameras.told.last().toStdString(), "choose1");
  EXPECT_FALSE(cameras.told.contains("look1")) << "a click marks, it does not move the view";
  cameras.told.clear();
  cameras.click(2);
  cameras.mouse(QEvent::MouseButtonDblClick, 2);
  EXPECT_TRUE(cameras.told.contains("look2"));
  cameras.told.clear();
  cameras.tree.setCurrentItem(cameras.row(1));
  cameras.told.clear();
  cameras.key(Qt::Key_Down);
  EXPECT_EQ(cameras.told, QStringList{"choose2"});
  cameras.key(Qt::Key_Return);
  EXPECT_EQ(cameras.told, (QStringList{"choose2", "look2"}));
  cameras.told.clear();
  panel.mark(ViewIndex{0});
  EXPECT_TRUE(cameras.told.isEmpty()) << "being shown is not choosing";
  EXPECT_TRUE(cameras.row(0)->isSelected());
  panel.mark(std::nullopt);
  EXPECT_FALSE(cameras.row(0)->isSelected());
  panel.setParent(nullptr);
}

TEST_F(Panels, LettersAndDigitsGoPastTheFramesBoxAndTheCameras) {
  struct Catcher : QWidget {
    void keyPressEvent(QKeyEvent* event) override { keys << event->text(); }
    QStringList keys;
  } catcher;
  auto* panel = new ProjectPanel(model, &catcher);
  auto* frames = panel->findChild<QComboBox*>();
  ASSERT_EQ(frames->count(), 3);
  for (QWidget* widget : {static_cast<QWidget*>(frames), static_cast<QWidget*>(&panel->cameras())}) {
    for (const QString& text : {QString("2"), QString("k")}) {
      QKeyEvent event(QEvent::KeyPress, text == "2" ? Qt::Key_2 : Qt::Key_K, Qt::NoModifier, text);
      QApplication::sendEvent(widget, &event);
    }
  }
  EXPECT_EQ(catcher.keys, (QStringList{"2", "k", "2", "k"}));
  EXPECT_EQ(frames->currentIndex(), 0);
}

TEST_F(Panels, CameraRowsCountTheirProblemsAndTellThem) {
  ProjectPanel panel(model);
  Cameras cameras(panel);
  panel.setProblems({{"C02", {"the photograph is cut off", "the mask is empty"}}});
  EXPECT_EQ(cameras.row(1)->text(2).toStdString(), "▲ 2");
  EXPECT_TRUE(cameras.row(1)->toolTip(0).contains("the mask is empty"));
  EXPECT_TRUE(cameras.row(0)->text(2).isEmpty());
  panel.setProblems({});
  EXPECT_TRUE(cameras.row(1)->text(2).isEmpty());
}

TEST_F(Panels, TheSizesOfCamerasGiveWayButDoNotVanish) {
  for (const double scale : {1.0, 1.5}) {
    for (const int width : {220, 280, 400}) {
      ProjectPanel panel(model);
      show(panel, width, 600, scale);
      QTreeWidget& tree = panel.cameras();
      EXPECT_FALSE(tree.isColumnHidden(1));
      const QFontMetrics metrics = tree.fontMetrics();
      const int wanted =
          width == 220 ? 5 * metrics.averageCharWidth() : metrics.horizontalAdvance("200 × 200");
      EXPECT_GE(tree.columnWidth(1), wanted) << width << " x" << scale;
      EXPECT_TRUE(tree.topLevelItem(0)->child(0)->toolTip(1).contains("200 × 200"));
      panel.setParent(nullptr);
    }
  }
}

TEST_F(Panels, TheProjectPanelFitsWhereItIsNarrowAndLow) {
  for (const double scale : {1.0, 1.5}) {
    ProjectPanel panel(model);
    show(panel, 220, 300, scale);
    EXPECT_LE(window.width(), 220) << scale;
    EXPECT_LE(window.height(), 300) << scale;
    const QWidget* inside = panel.findChild<QScrollArea*>()->widget();
    EXPECT_LE(inside->width(), 220) << "no sideways scrolling at " << scale;
    for (const QWidget* child : inside->findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly)) {
      EXPECT_TRUE(!child->isVisible() || inside->rect().contains(child->geometry()))
          << child->objectName().toStdString();
    }
    panel.setParent(nullptr);
  }
}

TEST_F(Panels, TheTransportFoldsIntoAMenuAndTheLanesScroll) {
  Player player(model, [] { return true; });
  for (const double scale : {1.0, 1.5}) {
    TimelinePanel panel(model, player);
    show(panel, 480, 160, scale);
    EXPECT_EQ(window.width(), 480) << scale;
    int shown = 0, right = 0;
    for (const QToolButton* button :
         panel.findChildren<QToolButton*>(QString(), Qt::FindDirectChildrenOnly)) {
      if (!button->isVisible()) continue;
      ++shown;
      EXPECT_GE(button->x(), 0);
      EXPECT_GE(button->width(), button->sizeHint().width());
      right = std::max(right, button->geometry().right());
    }
    EXPECT_GE(shown, 4);
    const auto* curves = panel.findChild<QComboBox*>();
    EXPECT_LT(right, curves->x());
    EXPECT_LE(curves->geometry().right(), 480);
    window.resize(1400, 400);
    QApplication::processEvents();
    int wide = 0;
    for (const QToolButton* button : panel.findChildren<QToolButton*>(QString(), Qt::FindDirectChildrenOnly))
      wide += button->isVisible();
    EXPECT_EQ(wide, 9) << "all buttons, no menu";
    panel.setParent(nullptr);
  }
}

TEST(Problems, EachIsListedOnceWithItsCountNewestFirst) {
  ProblemList problems;
  int changes = 0;
  QObject::connect(&problems, &ProblemList::changed, &problems, [&] { ++changes; });
  problems.add({.text = "cut off", .camera = "C02", .frame = "000001"});
  problems.add({.text = "drift", .stage = "track"});
  problems.add({.text = "cut off", .camera = "C02", .frame = "000001"});
  problems.add({.kind = Problem::Kind::Error, .text = "failed", .stage = "track", .frame = "000002"});
  ASSERT_EQ(problems.count(), 3);
  EXPECT_EQ(changes, 4);
  EXPECT_EQ(problems.all()[0].text.toStdString(), "failed");
  EXPECT_EQ(problems.all()[1].count, 2);
  EXPECT_EQ(problems.count(Problem::Kind::Error), 1);
  EXPECT_EQ(problems.countsByStage(), (std::map<std::string, int>{{"track", 2}}));
  EXPECT_EQ(problems.countsByCamera(), (std::map<std::string, int>{{"C02", 1}}));
  EXPECT_EQ(problems.textsByCamera().at("C02"), QStringList{"frame 000001: cut off"});
  problems.clear();
  EXPECT_EQ(problems.count(), 0);
}

TEST(Problems, ThePanelShowsCopiesAndCountsThem) {
  ProblemList problems;
  ProblemsPanel panel(problems);
  QStringList titles;
  QObject::connect(&panel, &ProblemsPanel::titleChanged, &panel,
                   [&](const QString& title) { titles << title; });
  auto* rows = panel.findChild<QListWidget*>();
  EXPECT_TRUE(rows->isHidden());
  EXPECT_EQ(panel.title().toStdString(), "Problems");
  problems.add({.text = "the older"});
  problems.add({.text = "the newer", .camera = "C02"});
  problems.add({.text = "the newer", .camera = "C02"});
  EXPECT_EQ(titles, (QStringList{"Problems (1)", "Problems (2)"}));
  ASSERT_EQ(rows->count(), 2);
  EXPECT_TRUE(rows->item(0)->text().contains("camera C02: the newer"));
  EXPECT_TRUE(rows->item(0)->text().contains("×2"));
  for (QToolButton* button : panel.findChildren<QToolButton*>()) {
    if (button->text() == "Copy all") button->click();
  }
  EXPECT_EQ(QApplication::clipboard()->text().count('\n'), 1);
  EXPECT_TRUE(QApplication::clipboard()->text().contains("the older"));
}

TEST(Log, TellsARepeatedLineOnceWithItsCount) {
  LogPanel log;
  log.add(LogLevel::Info, "first");
  for (int i = 0; i < 3; ++i) log.add(LogLevel::Warning, "again\nand again");
  log.add(LogLevel::Info, "last");
  EXPECT_EQ(log.document()->blockCount(), 3);
  EXPECT_TRUE(log.document()->findBlockByNumber(1).text().contains("×3"));
  EXPECT_FALSE(log.document()->findBlockByNumber(0).text().contains("×"));
}

TEST(Log, TellsInOrderAndByTheTitlesOfTheWindow) {
  StageInfo surface;
  surface.id = "surface";
  surface.title = "Surface";
  surface.steps = {{.id = "fit", .title = "Fit appearance"}};
  LogPanel log;
  log.setStages({surface});
  logInfo("surface.fit, frame 000000 done in 2.0 s");
  log.add(LogLevel::Info, "Done in 31 s");
  const auto line = [&](int i) { return log.document()->findBlockByNumber(i).text(); };
  ASSERT_EQ(log.document()->blockCount(), 2);
  EXPECT_TRUE(line(0).contains("Surface: fit appearance, frame 000000 done")) << line(0).toStdString();
  EXPECT_TRUE(line(1).contains("Done in 31 s")) << line(1).toStdString();
}

TEST(Log, KeepsTheNewestInViewUnlessAPersonScrolledUp) {
  LogPanel log;
  for (int i = 0; i < 200; ++i) log.add(LogLevel::Info, QString("line %1").arg(i));  // while it is hidden
  log.resize(400, 150);
  log.show();
  QApplication::processEvents();
  QScrollBar* bar = log.verticalScrollBar();
  ASSERT_GT(bar->maximum(), 0);
  EXPECT_EQ(bar->value(), bar->maximum());
  log.add(LogLevel::Info, "one more");
  EXPECT_EQ(bar->value(), bar->maximum());
  bar->triggerAction(QAbstractSlider::SliderToMinimum);
  log.add(LogLevel::Info, "another");
  EXPECT_EQ(bar->value(), 0) << "somebody reads there";
  bar->triggerAction(QAbstractSlider::SliderToMaximum);
  log.add(LogLevel::Info, "the last");
  EXPECT_EQ(bar->value(), bar->maximum());
}

TEST(Message, ALongTextScrollsAndLeavesTheViewItsRoom) {
  QWidget window;
  auto* column = new QVBoxLayout(&window);
  auto* message = new MessagePanel;
  auto* view = new QWidget;
  column->addWidget(message);
  column->addWidget(view, 1);
  window.resize(700, 600);
  window.show();
  message->show(MessagePanel::Kind::Error, "Short", "One line.");
  ASSERT_TRUE(waitFor([&] { return message->height() < 90; })) << message->height();
  QString text;
  for (int i = 0; i < 300; ++i)
    text += QString("Line %1 of what went wrong, and what to do about it.\n").arg(i);
  message->show(MessagePanel::Kind::Error, "Long", text);
  EXPECT_TRUE(waitFor([&] { return message->height() > 120 && view->height() > 0.6 * window.height(); }));
  EXPECT_LE(message->height(), 0.34 * window.height());
  EXPECT_EQ(window.height(), 600);
  EXPECT_EQ(message->text(), text);
  window.resize(700, 400);
  EXPECT_TRUE(waitFor([&] { return message->height() <= 0.36 * window.height(); })) << message->height();
}

TEST(Theme, TheSheetNamesNothingThatTheThemeDoesNotKnow) {
  auto& application = *static_cast<QApplication*>(QCoreApplication::instance());
  for (const Theme theme : {Theme::Dark, Theme::Light, Theme::System}) {
    applyTheme(application, theme);
    const QString sheet = application.styleSheet();
    EXPECT_GT(sheet.size(), 3000);
    for (const char* hole : {"@", ": ;", "solid ;", "()"}) EXPECT_FALSE(sheet.contains(hole)) << hole;
  }
  application.setStyleSheet({});
}

TEST(Theme, TextIsLegibleOnItsGround) {
  const auto luminance = [](const QColor& c) {
    const auto linear = [](double v) {
      return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(c.redF()) + 0.7152 * linear(c.greenF()) + 0.0722 * linear(c.blueF());
  };
  const auto contrast = [&](const QColor& a, const QColor& b) {
    const double x = luminance(a), y = luminance(b);
    return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
  };
  auto& application = *static_cast<QApplication*>(QCoreApplication::instance());
  for (const Theme theme : {Theme::Dark, Theme::Light}) {
    applyTheme(application, theme);
    const Colors& c = colors();
    // WCAG 2.1: 4.5 for text, 3 for signs.
    for (const QColor& text : {c.text, c.strong, c.muted, c.quiet}) {
      for (const QColor& ground : {c.window, c.chrome, c.card})
        EXPECT_GE(contrast(text, ground), 4.5)
            << text.name().toStdString() << " on " << ground.name().toStdString();
    }
    for (const QColor& sign : {c.done, c.failed, c.stale, c.running, c.warning, c.accent})
      EXPECT_GE(contrast(sign, c.card), 3) << sign.name().toStdString();
    EXPECT_GE(contrast(c.error_text, c.error_back), 4.5);
    EXPECT_GE(contrast(c.notice_text, c.notice_back), 4.5);
    EXPECT_GE(contrast(c.primary_text, c.primary), 4.5);
    for (const QColor& ground : {c.progress, c.edge}) EXPECT_GE(contrast(c.strong, ground), 4.5);
  }
  applyTheme(application);
  application.setStyleSheet({});
}

TEST(Theme, AllTextGrowsByTheScale) {
  auto& application = *static_cast<QApplication*>(QCoreApplication::instance());
  applyTheme(application, Theme::Dark, 1);
  QLabel plain("words"), title("words");
  title.setObjectName("title");
  const int before = plain.sizeHint().height(), title_before = title.sizeHint().height();
  applyTheme(application, Theme::Dark, 1.5);
  QLabel grown("words"), grown_title("words");
  grown_title.setObjectName("title");
  EXPECT_NEAR(grown.sizeHint().height(), 1.5 * before, 4);
  EXPECT_NEAR(grown_title.sizeHint().height(), 1.5 * title_before, 6);
  applyTheme(application);
  application.setStyleSheet({});
}

}  // namespace
}  // namespace beam
