// SPDX-License-Identifier: Apache-2.0
#include "ui/main_window.h"

#include <unistd.h>

#include <QAbstractSpinBox>
#include <QCloseEvent>
#include <QComboBox>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QMenuBar>
#include <QMimeData>
#include <QScreen>
#include <QStackedWidget>
#include <QStatusBar>
#include <QTabBar>
#include <QTabWidget>
#include <QTextEdit>
#include <QUrl>
#include <QVBoxLayout>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/pipeline/machine_times.h"
#include "ui/display_panel.h"
#include "ui/elided_label.h"
#include "ui/image_page.h"
#include "ui/log_panel.h"
#include "ui/message_panel.h"
#include "ui/project_panel.h"
#include "ui/run_bar.h"
#include "ui/settings_panel.h"
#include "ui/stage_rail.h"
#include "ui/start_page.h"
#include "ui/timeline_panel.h"
#include "ui/words.h"
#include "viewers/image/image_view.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"
#include "viewers/view_keys.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr const char* kViewNames[] = {"splat", "image", "scene"};
constexpr const char* kScopeNames[] = {"frame", "range", "take", "scout"};
constexpr QSize kUsualSize(1600, 1000), kLeastSize(1000, 640);

QString machineText(const RendererAbilities& renderer) {
  const double memory_gb =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e9;
  return QString(
             "%1, %2 GB of memory. No graphics card is needed: Gaussians are rasterised on the processor and "
             "only shown through OpenGL.")
      .arg(QString::fromStdString(renderer.title))
      .arg(memory_gb, 0, 'f', 0);
}

// Letters and digits typed there are meant for it.
bool takesText(const QWidget* widget) {
  const auto* combo = qobject_cast<const QComboBox*>(widget);
  return qobject_cast<const QLineEdit*>(widget) || qobject_cast<const QTextEdit*>(widget) ||
         qobject_cast<const QAbstractSpinBox*>(widget) || (combo && combo->isEditable());
}

}  // namespace

std::optional<StudioView> studioViewNamed(std::string_view name) {
  for (int i = 0; i < 3; ++i) {
    if (name == kViewNames[i]) return static_cast<StudioView>(i);
  }
  return std::nullopt;
}

std::optional<RunScope> runScopeNamed(std::string_view name) {
  for (int i = 0; i < 4; ++i) {
    if (name == kScopeNames[i]) return static_cast<RunScope>(i);
  }
  return std::nullopt;
}

MainWindow::MainWindow(StudioServices services, Layout layout)
    : services_(services),
      memory_(layout == Layout::Remembered),
      model_(std::move(services)),
      lights_(services_.new_renderer),
      player_(model_, [this] { return viewFollows(); }),
      joints_(model_) {
  setAcceptDrops(true);
  setMinimumSize(kLeastSize);
  {
    const WithoutSheet bare;
    makeParts();
    makeCommands();
    makeTop();
    makeCentre();
    makeDocks();
    makeMenus();
  }
  connectModel();
  connectViews();
  connectJob();
  connectTask();
  connectWatch();
  connectPlayer();
  fitToScreen();
  fresh_state_ = saveState();
  showPanels(false);
  if (memory_.lasts()) restoreLayout();
  recallTimes();
  showRecent();
  refreshCommands();
  showTitle();
  showStatus();
}

// Parts that still have something to tell when they go (a model that saves) must not reach those that are
// gone.
MainWindow::~MainWindow() {
  for (QObject* part :
       {static_cast<QObject*>(&model_), static_cast<QObject*>(&lights_), static_cast<QObject*>(&job_),
        static_cast<QObject*>(&task_), static_cast<QObject*>(&player_), static_cast<QObject*>(&watch_),
        static_cast<QObject*>(&problems_), static_cast<QObject*>(&forecast_)})
    part->disconnect(this);
}

void MainWindow::makeParts() {
  rail_ = new StageRail;
  run_bar_ = new RunBar;
  run_bar_->setStages(services_.pipeline->stages.infos());
  message_ = new MessagePanel;
  splat_ = new SplatView(services_.new_renderer);
  start_ = new StartPage(machineText(splat_->abilities()));
  images_ = new ImagePage(model_);
  scene_ = new SceneView;
  rail_->setStages(stagesWithoutTake(services_.pipeline->stages.infos()));
  rail_->select("surface");
  rail_->setEnabled(false);
}

// Menus above stages and run bar, over the whole width. No tool bar: one that is too narrow hides what does
// not fit.
void MainWindow::makeTop() {
  auto* top = new QWidget;
  auto* column = new QVBoxLayout(top);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  menus_ = new QMenuBar;
  column->addWidget(menus_);
  auto* stages = new QFrame;
  stages->setObjectName("stages");
  auto* row = new QHBoxLayout(stages);
  row->setContentsMargins(8, 4, 8, 4);
  row->setSpacing(14);
  row->addWidget(rail_);
  row->addWidget(run_bar_, 1);
  column->addWidget(stages);
  setMenuWidget(top);
}

void MainWindow::makeCentre() {
  view_tabs_ = new QTabBar;
  view_tabs_->setObjectName("views");
  view_tabs_->setExpanding(false);
  view_tabs_->setDrawBase(false);
  views_ = new QStackedWidget;
  const auto add = [this](QWidget* view, const char* title, const char* tip) {
    views_->addWidget(view);
    view_tabs_->setTabToolTip(view_tabs_->addTab(title), tip);
  };
  add(splat_, "Splats", "The Gaussians, lit or by channel (Ctrl+1)");
  add(images_, "Images", "Photographs and maps, two under a wipe, or their difference (Ctrl+2)");
  add(scene_, "Scene", "Cameras, seed points, ellipsoids and mesh in the world (Ctrl+3)");
  connect(view_tabs_, &QTabBar::currentChanged, views_, &QStackedWidget::setCurrentIndex);
  auto* work = new QWidget;
  auto* column = new QVBoxLayout(work);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(view_tabs_);
  column->addWidget(views_, 1);
  centre_ = new QStackedWidget;
  centre_->addWidget(start_);
  centre_->addWidget(work);
  auto* middle = new QWidget;
  auto* all = new QVBoxLayout(middle);
  all->setContentsMargins(0, 0, 0, 0);
  all->setSpacing(0);
  all->addWidget(message_);
  all->addWidget(centre_, 1);
  setCentralWidget(middle);
}

void MainWindow::makeDocks() {
  const auto dock = [this](const char* name, const char* title, QWidget* widget, Qt::DockWidgetArea area) {
    auto* d = new QDockWidget(title);
    d->setObjectName(name);
    d->setWidget(widget);
    d->setFeatures(QDockWidget::DockWidgetMovable | QDockWidget::DockWidgetClosable);
    addDockWidget(area, d);
    return d;
  };
  setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  project_panel_ = new ProjectPanel(model_);
  settings_ = new SettingsPanel(model_);
  display_ = new DisplayPanel(*splat_, lights_);
  connect(display_, &DisplayPanel::openLightWanted, commands_.action("open_light"), &QAction::trigger);
  inspector_ = new QTabWidget;
  inspector_->setDocumentMode(true);
  inspector_->tabBar()->setDrawBase(false);
  inspector_->addTab(display_, "Display");
  inspector_->addTab(settings_, "Settings");
  inspector_->setTabToolTip(0, "How the view that is seen shows: channel, light, exposure");
  inspector_->setTabToolTip(1, "The settings of the chosen stage");
  connect(rail_, &StageRail::chosen, this, [this](const std::string& stage) {
    if (!settings_->setStage(stage)) rail_->select(settings_->stage());
    inspector_->setCurrentWidget(settings_);
  });
  log_ = new LogPanel;
  log_->setStages(services_.pipeline->stages.infos());
  dock("project", "Project", project_panel_, Qt::LeftDockWidgetArea);
  QDockWidget* inspector = dock("inspector", "Inspector", inspector_, Qt::RightDockWidgetArea);
  connect(settings_, &SettingsPanel::attentionWanted, inspector_, [this, inspector] {
    inspector->show();
    inspector_->setCurrentWidget(settings_);
  });
  QDockWidget* bottom = dock("log", "Log", log_, Qt::BottomDockWidgetArea);
  timeline_ = new TimelinePanel(model_, player_);
  QDockWidget* timeline = dock("timeline", "Timeline", timeline_, Qt::BottomDockWidgetArea);
  tabifyDockWidget(timeline, bottom);
  timeline->raise();
  auto* problems = new ProblemsPanel(problems_);
  problems_dock_ = dock("problems", "Problems", problems, Qt::BottomDockWidgetArea);
  connect(problems, &ProblemsPanel::titleChanged, problems_dock_, &QDockWidget::setWindowTitle);
  connect(problems, &ProblemsPanel::told, this, [this](const QString& words) { reading_->setText(words); });
  tabifyDockWidget(bottom, problems_dock_);
  timeline->raise();
  settings_->setStage(rail_->selected());
  reading_ = new ElidedLabel;
  state_words_ = new ElidedLabel;
  for (ElidedLabel* words : {reading_, state_words_})
    words->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  state_words_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  statusBar()->addWidget(reading_, 1);
  statusBar()->addWidget(state_words_, 1);
  statusBar()->setSizeGripEnabled(false);
}

// As large as usual, on a smaller screen all of that; the frame that the desktop draws has to fit, too.
void MainWindow::fitToScreen() {
  constexpr QSize kFrame(16, 48);
  const QScreen* screen = QGuiApplication::primaryScreen();
  const QSize room = screen ? screen->availableGeometry().size() - kFrame : kUsualSize;
  resize(kUsualSize.boundedTo(room).expandedTo(kLeastSize));
}

void MainWindow::showView(StudioView view) {
  view_tabs_->setCurrentIndex(static_cast<int>(view));
  if (model_.isOpen()) viewWidget()->setFocus();
}

StudioView MainWindow::shownView() const { return static_cast<StudioView>(views_->currentIndex()); }

QWidget* MainWindow::viewWidget() const {
  QWidget* const widgets[] = {splat_, &images_->view(), scene_};
  return widgets[static_cast<int>(shownView())];
}

bool MainWindow::viewSettled() const {
  switch (shownView()) {
    case StudioView::Splat:
      return splat_->settled();
    case StudioView::Image:
      return images_->view().settled();
    case StudioView::Scene:
      return joints_.settled() && scene_->settled();
  }
  return true;
}

bool MainWindow::viewFollows() const {
  return shownView() == StudioView::Splat ? splat_->upToDate() : viewSettled();
}

bool MainWindow::settled() const {
  if (task_.busy() || !model_.settled() || !lights_.settled()) return false;
  return !model_.isOpen() || viewSettled();
}

// Ctrl with a digit of the number pad looks from the other side, wherever the focus is; without the pad it
// chooses a view.
bool MainWindow::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride && presetOf(*static_cast<QKeyEvent*>(event)) &&
      !takesText(focusWidget())) {
    event->accept();
    return true;
  }
  return QMainWindow::event(event);
}

// A dock behind the tab of another one is shown, for Qt, but far outside of the window: nobody would see that
// it has the focus.
bool MainWindow::focusNextPrevChild(bool next) {
  const auto behind_a_tab = [this](const QWidget* widget) {
    while (widget && !qobject_cast<const QDockWidget*>(widget)) widget = widget->parentWidget();
    return widget && !widget->isWindow() && !widget->geometry().intersects(rect());
  };
  const QWidget* const first = focusWidget();
  do {
    if (!QMainWindow::focusNextPrevChild(next)) return false;
  } while (focusWidget() != first && behind_a_tab(focusWidget()));
  return true;
}

// Keys that no text field or list took go to the view that is seen.
void MainWindow::keyPressEvent(QKeyEvent* event) {
  bool taken = false;
  if (centre_->currentIndex() == 1 && !takesText(focusWidget())) {
    switch (shownView()) {
      case StudioView::Splat:
        taken = splat_->handleKey(*event);
        break;
      case StudioView::Image:
        taken = images_->view().handleKey(*event);
        break;
      case StudioView::Scene:
        taken = scene_->handleKey(*event);
        break;
    }
    taken = taken || timeline_->handleKey(*event);
  }
  if (!taken) QMainWindow::keyPressEvent(event);
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  for (const QUrl& url : event->mimeData()->urls()) {
    if (url.isLocalFile()) {
      open(url.toLocalFile().toStdString());
      event->acceptProposedAction();
      return;
    }
  }
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!mayClose()) return event->ignore();
  memory_.keepBytes("geometry", saveGeometry());
  memory_.keepBytes("docks", panels_state_.isEmpty() ? saveState() : panels_state_);
  memory_.keepNumber("view", views_->currentIndex());
  rememberProject();
  job_.requestStop();
  task_.requestStop();
  event->accept();
}

void MainWindow::recallLook() {
  chooseLook(static_cast<Theme>(std::clamp(memory_.number("theme", static_cast<int>(Theme::Dark)), 0, 2)),
             std::clamp(memory_.number("text_percent", 100), 100, 150));
}

void MainWindow::restoreLayout() {
  restoreGeometry(memory_.bytes("geometry"));
  // Not by way of restoreState: a window that was never shown would lose the sizes of its panels.
  if (const QByteArray kept = memory_.bytes("docks"); !kept.isEmpty()) panels_state_ = kept;
  view_tabs_->setCurrentIndex(memory_.number("view", 0));
}

void MainWindow::showPanels(bool shown) {
  if (shown != panels_state_.isEmpty()) {
    if (shown) {
      restoreState(panels_state_);
      panels_state_.clear();
      if (memory_.bytes("docks").isEmpty()) sizePanels();
    } else {
      panels_state_ = saveState();
      for (QDockWidget* dock : findChildren<QDockWidget*>()) dock->hide();
    }
  }
  for (QDockWidget* dock : findChildren<QDockWidget*>()) {
    dock->toggleViewAction()->setEnabled(shown);
    dock->toggleViewAction()->setToolTip(shown ? "Show or hide the panel " + dock->objectName()
                                               : "Panels are shown once a capture or project is open.");
  }
}

// As at first; what a person made of them comes back with the state that was kept.
void MainWindow::sizePanels() {
  const auto dock = [this](const char* name) { return findChild<QDockWidget*>(name); };
  resizeDocks({dock("project"), dock("inspector")}, {280, 340}, Qt::Horizontal);
  resizeDocks({dock("timeline")}, {std::clamp(28 * height() / 100, 170, 270)}, Qt::Vertical);
}

void MainWindow::recallTimes() { forecast_.setMachineTimes(readMachineTimes()); }

void MainWindow::unsay(const QStringList& titles) {
  if (titles.contains(message_->title())) message_->hide();
}

void MainWindow::tellOfFault(const QString& what) {
  say("Something went wrong in the program",
      what + " What is finished is on disk; save the settings and start the program anew.");
}

void MainWindow::say(const QString& title, const QString& told, QAction* remedy) {
  const QString text = withStepTitles(services_.pipeline->stages.infos(), told);
  message_->show(MessagePanel::Kind::Error, title, text, remedy);
  log_->add(LogLevel::Error, title + ": " + text);
  problems_.add(problemOf(Problem::Kind::Error, title + ": " + text));
}

}  // namespace beam
