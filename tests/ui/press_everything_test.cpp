// SPDX-License-Identifier: Apache-2.0
// Presses everything that can be pressed, in every state of the window: it either does something that can be
// seen or is grey and says why. What is wrong is listed all at once, by its words and where it stands.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QApplication>
#include <QDockWidget>
#include <QMetaMethod>
#include <QSettings>
#include <QSurfaceFormat>
#include <QTabBar>
#include <QtTest/QTest>

#include <functional>

#include "core/io/file.h"
#include "tests/support/pressing.h"
#include "tests/support/stand_in_studio.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "ui/main_window.h"
#include "ui/stage_rail.h"
#include "ui/theme.h"
#include "ui/timeline_lanes.h"
#include "ui/timeline_panel.h"
#include "viewers/gl/functions.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using namespace testing;

constexpr QSize kWindow{1400, 900};           // small windows are the matter of fit_test
constexpr int kFrame = 2, kIn = 1, kOut = 4;  // in the middle: every way to go leads somewhere
constexpr int kPatience_ms = 400, kPicturePatience_ms = 1200;

enum class State { NoProject, Opened, Solved, Running, ReadOnly, CaptureLost };

using Room = std::vector<std::pair<QString, int>>;  // tab bars and which tab of each is in front

// A window in a state, made anew whenever a press has led out of it.
class Bench {
 public:
  explicit Bench(State state) : state_(state) { make(); }
  ~Bench() { drop(); }

  MainWindow& window() { return *window_; }
  // Everything that can be pressed: at once, or behind one tab.
  std::vector<Control> controls();
  // What is wrong with the control; empty: nothing.
  QString tryOut(const Control& control);

 private:
  void make();
  void drop();
  void watch();
  void openProject();
  void takePlace();
  void setTheScene();
  void enter(const Room& room);
  void ready(const Control& control);
  void settle();
  QString signature();
  std::vector<Spot> spots();
  Room tabsInFront();
  Room roomOf(const QString& tab);
  bool hasPicture();
  std::set<QString> changes(const WindowLook& before, const Control& control);
  bool pressAndRead(const Control& control);
  bool pressAndCompare(const Control& control);

  State state_;
  TempDir folder_;  // one for all windows: its name stands on buttons
  std::unique_ptr<MainWindow> window_;
  std::unique_ptr<Opened> opened_;
  Room base_;
  QString signature_;
  bool watched_ = false;
  std::set<QString> restless_;
};

bool startsFromCapture(State state) { return state == State::Opened || state == State::Running; }

void Bench::make() {
  drop();
  qputenv("XDG_DATA_HOME", (folder_ / "data").c_str());
  const fs::path capture = folder_ / "capture", project = folder_ / "capture.beam";
  if (state_ == State::NoProject || startsFromCapture(state_)) {
    fs::create_directories(capture);
  } else {
    copySolvedStandIn(folder_.path());
  }
  if (state_ == State::CaptureLost) fs::remove_all(capture);
  if (state_ == State::ReadOnly) fs::permissions(project, fs::perms(0555));
  QSettings().setValue("recent", QStringList{QString::fromStdString(capture.string())});
  window_ = std::make_unique<MainWindow>(standInServices(), MainWindow::Layout::Fresh);
  window_->resize(kWindow);
  window_->show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(window_.get()));
  opened_ = std::make_unique<Opened>(*window_);
  openProject();
  for (auto* dock : window_->findChildren<QDockWidget*>("project"))
    window_->resizeDocks({dock}, {330}, Qt::Horizontal);  // a layout that can be reset
  settle();
  base_ = tabsInFront();
  setTheScene();
  if (!watched_) watch();
  signature_ = signature();
  opened_->take();
}

// What changes by itself in this state; the paths are the same in the next window.
void Bench::watch() {
  watched_ = true;
  const WindowLook look = lookAt(*window_);
  QTest::qWait(500);
  restless_ = differences(look, lookAt(*window_));
}

void Bench::openProject() {
  if (state_ == State::NoProject) return;
  window_->open(folder_ / (startsFromCapture(state_) ? "capture" : "capture.beam"));
  waitFor([&] { return !window_->model().opening() && window_->settled(); }, 8000);
  if (state_ != State::Running) return;
  takePlace();
  holdStandInRuns(true);
  window_->run();
  waitFor([&] { return window_->job().busy(); });
  QTest::qWait(300);  // events and the first preview arrive
}

void Bench::drop() {
  holdStandInRuns(false);
  opened_.reset();
  window_.reset();
  if (fs::exists(folder_ / "capture.beam")) fs::permissions(folder_ / "capture.beam", fs::perms(0755));
  for (const auto& entry : fs::directory_iterator(folder_.path())) fs::remove_all(entry.path());
}

void Bench::settle() {
  if (state_ == State::Running) return QTest::qWait(30);
  waitFor([&] { return window_->settled(); }, 4000);
}

void Bench::takePlace() {
  window_->player().goTo(kFrame);
  window_->player().setIn(kIn);
  window_->player().setOut(kOut);
}

void Bench::setTheScene() {
  if (window_->model().isOpen()) takePlace();
  settle();
}

Room Bench::tabsInFront() {
  Room room;
  for (const auto& [path, w] : widgetsByPath(*window_)) {
    if (const auto* tabs = qobject_cast<const QTabBar*>(w)) room.emplace_back(path, tabs->currentIndex());
  }
  return room;
}

void Bench::enter(const Room& room) {
  auto all = widgetsByPath(*window_);
  for (const auto& [path, index] : room) {
    const auto found = all.find(path);
    auto* tabs = found == all.end() ? nullptr : qobject_cast<QTabBar*>(found->second);
    if (!tabs || tabs->currentIndex() == index) continue;
    QTest::mouseClick(tabs, Qt::LeftButton, {}, tabs->tabRect(index).center());
    all = widgetsByPath(*window_);
  }
}

// Whether a press has led somewhere from where tabs do not lead back.
QString Bench::signature() {
  QStringList words{QString::number(window_->model().isOpen()), QString::number(window_->job().busy()),
                    QString::number(static_cast<int>(window_->windowState())),
                    QString::number(window_->isVisible()), QString::number(window_->model().unsaved())};
  for (const auto& [path, w] : widgetsByPath(*window_)) {
    words << path;
    if (w->inherits("QDockWidget")) words << QString::number(w->width()) << QString::number(w->height());
  }
  return words.join("\n");
}

void Bench::ready(const Control& control) {
  QApplication::processEvents();
  opened_->take();
  enter(base_);
  setTheScene();
  // What a drawn control has chosen is in no signature.
  if (control.kind == ControlKind::Spot || signature() != signature_) make();
  QApplication::setActiveWindow(window_.get());  // there is no window manager that would
  enter(control.room);
  settle();
  const auto all = widgetsByPath(*window_);
  if (const auto w = all.find(control.path); w != all.end() && control.kind != ControlKind::Shortcut) {
    // A ring and a glow under the mouse come to a dead control, too: they are there before.
    w->second->setFocus(Qt::MouseFocusReason);
    QTest::mouseMove(w->second);
  }
  QApplication::processEvents();
  opened_->take();
}

std::vector<Spot> Bench::spots() {
  std::vector<Spot> found;
  StageRail& rail = window_->rail();
  const int stages = static_cast<int>(standInServices().pipeline->stages.infos().size());
  // A rail that draws its stages itself has them side by side.
  if (rail.findChildren<QAbstractButton*>().empty()) {
    for (int i = 0; i < stages; ++i)
      found.push_back({&rail,
                       {(2 * i + 1) * rail.width() / (2 * stages), rail.height() / 2},
                       QString("stage %1").arg(i + 1)});
  }
  TimelineLanes& lanes = window_->timeline().lanes();
  if (window_->model().isOpen())
    found.push_back({&lanes, {static_cast<int>(lanes.centerOf(kFrame + 1)), 30}, "the next frame"});
  return found;
}

Room Bench::roomOf(const QString& tab) {
  for (const auto& [path, w] : widgetsByPath(*window_)) {
    const auto* tabs = qobject_cast<const QTabBar*>(w);
    for (int i = 0; tabs && i < tabs->count(); ++i) {
      if (plainText(tabs->tabText(i)) == tab) return {{path, i}};
    }
  }
  return {};
}

std::vector<Control> Bench::controls() {
  std::vector<Control> all;
  std::set<Control> known;
  const auto add = [&](const Room& room) {
    for (Control& control : controlsIn(*window_, spots())) {
      if (!known.insert(control).second) continue;
      // Where the settings of the chosen stage are in view, a press on it has nothing left to do.
      control.room = control.kind == ControlKind::Spot ? roomOf("Display") : room;
      all.push_back(std::move(control));
    }
  };
  add({});
  for (const Control& tab : std::vector<Control>(all)) {
    if (tab.kind != ControlKind::Tab) continue;
    enter(base_);
    enter({{tab.path, tab.index}});
    settle();
    add({{tab.path, tab.index}});
  }
  return all;
}

// Where there is something to see, the choice alone is no answer.
bool Bench::hasPicture() { return window_->model().isOpen() && window_->model().values().cloud; }

std::set<QString> Bench::changes(const WindowLook& before, const Control& control) {
  std::set<QString> keys;
  for (const QString& key : differences(before, lookAt(*window_))) {
    if (!restless_.contains(key) && !(isOwnValue(control, key) && hasPicture())) keys.insert(key);
  }
  return keys;
}

bool Bench::pressAndRead(const Control& control) {
  const WindowLook before = lookAt(*window_);
  bool fired = false;
  QObject guard;  // of these connections
  for (const QAction* action : window_->findChildren<QAction*>())
    QObject::connect(action, &QAction::triggered, &guard, [&] { fired = true; });
  press(*window_, control, spots(), *opened_);
  // What a shortcut starts is pressed in its menu.
  if (control.kind == ControlKind::Shortcut) return fired;
  return waitFor([&] { return !opened_->take().empty() || !changes(before, control).empty(); }, kPatience_ms);
}

// Outside of `own`, and where the picture did not change by itself.
bool differ(const QImage& first, const QImage& before, const QImage& after, const QRect& own) {
  if (after.size() != before.size()) return true;
  for (int y = 0; y < after.height(); ++y) {
    const auto row = [y](const QImage& image) {
      return reinterpret_cast<const QRgb*>(image.constScanLine(y));
    };
    const QRgb *f = row(first), *b = row(before), *a = row(after);
    for (int x = 0; x < after.width(); ++x) {
      if (a[x] != b[x] && f[x] == b[x] && !own.contains(x, y)) return true;
    }
  }
  return false;
}

bool Bench::pressAndCompare(const Control& control) {
  ready(control);
  const QRect own = ownPlace(*window_, control);
  const auto picture = [&] { return window_->grab().toImage().convertToFormat(QImage::Format_RGB32); };
  const QImage first = picture();
  QTest::qWait(150);
  const QImage before = picture();
  press(*window_, control, spots(), *opened_);
  return waitFor([&] { return !opened_->take().empty() || differ(first, before, picture(), own); },
                 kPicturePatience_ms);
}

// The words of a control while it works and while it is grey, over all states.
struct Tips {
  std::set<QString> works, grey;
};
std::map<QString, Tips>& tipsByControl() {
  static std::map<QString, Tips> all;
  return all;
}

QString Bench::tryOut(const Control& control) {
  ready(control);
  const Standing standing = standingOf(*window_, control, spots());
  if (!standing.there || standing.already) return {};
  Tips& tips = tipsByControl()[control.id()];
  if (standing.grey) {
    tips.grey.insert(standing.reason);
    if (standing.reason.isEmpty()) return "is grey and says not why";
    return standing.hindrance;
  }
  tips.works.insert(standing.reason);
  if (!standing.hindrance.isEmpty()) return standing.hindrance;
  if (pressAndRead(control)) return {};
  if (control.kind == ControlKind::Shortcut) return "starts nothing";
  // One of several that was not the chosen one and is now: a second press could change nothing.
  if (standingOf(*window_, control, spots()).already) return {};
  // A drawing of its own answers in its own place.
  return pressAndCompare(control) ? QString() : "does nothing that can be seen";
}

void pressEverything(State state) {
  Bench bench(state);
  const std::vector<Control> controls = bench.controls();
  EXPECT_GT(controls.size(), 60u) << "the window is hardly that empty";
  QStringList wrong;
  for (const Control& control : controls) {
    QString what = bench.tryOut(control);
    if (!what.isEmpty()) what = bench.tryOut(control);  // a busy machine may have answered late
    if (!what.isEmpty()) wrong << control.title() + " " + what;
  }
  EXPECT_TRUE(wrong.isEmpty()) << wrong.size() << " of " << controls.size() << " controls:\n"
                               << wrong.join("\n").toStdString();
}

TEST(EverythingDoesSomethingOrSaysWhyNot, WithoutAProject) { pressEverything(State::NoProject); }
TEST(EverythingDoesSomethingOrSaysWhyNot, WithACaptureJustOpened) { pressEverything(State::Opened); }
TEST(EverythingDoesSomethingOrSaysWhyNot, WithASolvedTake) { pressEverything(State::Solved); }
TEST(EverythingDoesSomethingOrSaysWhyNot, DuringARun) { pressEverything(State::Running); }
TEST(EverythingDoesSomethingOrSaysWhyNot, InAReadOnlyProject) { pressEverything(State::ReadOnly); }
TEST(EverythingDoesSomethingOrSaysWhyNot, WithoutItsCapture) { pressEverything(State::CaptureLost); }

// After all states, whose tips it compares; alone it has nothing to say.
TEST(EverythingDoesSomethingOrSaysWhyNot, SaysAnotherThingWhereItIsGreyThanWhereItWorks) {
  QStringList wrong;
  for (const auto& [control, tips] : tipsByControl()) {
    for (const QString& reason : tips.grey) {
      if (!reason.isEmpty() && tips.works.contains(reason))
        wrong << control + " is grey with the words of when it works: " + reason;
    }
  }
  EXPECT_TRUE(wrong.isEmpty()) << wrong.join("\n").toStdString();
}

TEST(Shortcuts, NoTwoEntriesThatWorkShareAShortcut) {
  for (const State state : {State::NoProject, State::Solved, State::Running}) {
    Bench bench(state);
    std::map<QString, QString> owner;
    for (const QAction* action : bench.window().findChildren<QAction*>()) {
      for (const QKeySequence& keys : action->shortcuts()) {
        if (keys.isEmpty() || !action->isEnabled()) continue;
        const auto [at, fresh] = owner.emplace(keys.toString(), action->text());
        EXPECT_TRUE(fresh) << keys.toString().toStdString() << " starts both " << at->second.toStdString()
                           << " and " << action->text().toStdString();
      }
    }
  }
}

// --- Signals ---

// Signals that nobody in the window needs to hear, each with its reason.
const std::map<std::string, std::string>& unheard() {
  static const std::map<std::string, std::string> kReasons = {};
  return kReasons;
}

struct Peek : QObject {
  using QObject::isSignalConnected;  // protected in QObject; asking changes nothing
};

void addUnconnected(const QObject& object, std::set<std::string>& found) {
  bool (QObject::*const connected)(const QMetaMethod&) const = &Peek::isSignalConnected;
  for (const QMetaObject* kind = object.metaObject(); kind; kind = kind->superClass()) {
    const std::string name = kind->className();
    if (!name.starts_with("beam::")) continue;
    for (int i = kind->methodOffset(); i < kind->methodCount(); ++i) {
      const QMetaMethod method = kind->method(i);
      const std::string signal = name + "::" + method.name().toStdString();
      if (method.methodType() == QMetaMethod::Signal && !(object.*connected)(method) &&
          !unheard().contains(signal))
        found.insert(signal);
    }
  }
}

TEST(Signals, EverySignalOfTheWindowIsHeard) {
  Bench bench(State::Solved);
  MainWindow& window = bench.window();
  std::set<std::string> found;
  for (const QObject* object : window.findChildren<QObject*>()) addUnconnected(*object, found);
  for (const QObject* object : std::initializer_list<const QObject*>{
           &window, &window.model(), &window.lights(), &window.job(), &window.player(), &window.joints()})
    addUnconnected(*object, found);
  for (const std::string& signal : found) ADD_FAILURE() << "nothing is connected to " << signal;
}

}  // namespace
}  // namespace beam

// The window's own main: settings and data of this test alone.
int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  QSurfaceFormat::setDefaultFormat(beam::surfaceFormat());
  QApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
  QApplication application(argc, argv);
  const beam::testing::TempDir settings;
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path().c_str());
  QApplication::setOrganizationName("BEAM Studio test");
  QApplication::setApplicationName("press");
  beam::applyTheme(application);
  return RUN_ALL_TESTS();
}
