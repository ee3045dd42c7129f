// SPDX-License-Identifier: Apache-2.0
#include "ui/main_window.h"

#include <unistd.h>

#include <QCloseEvent>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMimeData>
#include <QScrollArea>
#include <QSettings>
#include <QStackedWidget>
#include <QStatusBar>
#include <QTabBar>
#include <QTabWidget>
#include <QToolBar>
#include <QUrl>
#include <QVBoxLayout>

#include "ui/display_panel.h"
#include "ui/image_page.h"
#include "ui/log_panel.h"
#include "ui/message_panel.h"
#include "ui/project_panel.h"
#include "ui/run_bar.h"
#include "ui/settings_panel.h"
#include "ui/stage_rail.h"
#include "ui/start_page.h"
#include "ui/timeline_panel.h"
#include "viewers/image/image_view.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr const char* kViewNames[] = {"splat", "image", "scene"};
constexpr const char* kScopeNames[] = {"frame", "range", "take", "scout"};

QString machineText(const StudioServices& services) {
  const double memory_gb =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e9;
  return QString(
             "%1, %2 GB of memory. No graphics card is needed: Gaussians are rasterised on the processor and "
             "only shown through OpenGL.")
      .arg(QString::fromStdString(services.view_device->info().title))
      .arg(memory_gb, 0, 'f', 0);
}

bool isPanorama(const fs::path& path) { return path.extension() == ".exr" || path.extension() == ".hdr"; }

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
      model_(std::move(services)),
      player_(model_, [this] { return viewFollows(); }),
      joints_(model_),
      layout_(layout) {
  setAcceptDrops(true);
  setMinimumSize(1000, 640);
  resize(1600, 1000);
  makeParts();
  makeCentre();
  makeDocks();
  makeMenus();
  connectModel();
  connectViews();
  connectJob();
  connectPlayer();
  fresh_state_ = saveState();
  if (layout_ == Layout::Remembered) restoreLayout();
  start_->setRecent(QSettings().value("recent").toStringList());
  showTitle();
  showStatus();
}

MainWindow::~MainWindow() = default;

void MainWindow::makeParts() {
  rail_ = new StageRail;
  run_bar_ = new RunBar;
  run_bar_->setStages(services_.pipeline->stages.infos());
  message_ = new MessagePanel;
  start_ = new StartPage(static_cast<bool>(services_.make_sample), machineText(services_));
  splat_ = new SplatView(services_.view_device);
  images_ = new ImagePage(model_);
  scene_ = new SceneView;
  rail_->setStages(stagesWithoutTake(services_.pipeline->stages.infos()));
  rail_->select("surface");
}

void MainWindow::makeCentre() {
  auto* bar = new QToolBar("Stages");
  bar->setObjectName("stages");
  bar->setMovable(false);
  bar->setContextMenuPolicy(Qt::PreventContextMenu);
  auto* inside = new QWidget;
  auto* row = new QHBoxLayout(inside);
  row->setContentsMargins(2, 0, 2, 0);
  row->setSpacing(14);
  row->addWidget(rail_);
  row->addWidget(run_bar_, 1);
  bar->addWidget(inside);
  addToolBar(Qt::TopToolBarArea, bar);

  view_tabs_ = new QTabBar;
  view_tabs_->setExpanding(false);
  view_tabs_->setDrawBase(false);
  view_tabs_->setFocusPolicy(Qt::NoFocus);
  views_ = new QStackedWidget;
  const auto add = [this](QWidget* view, const char* title, const char* tip) {
    views_->addWidget(view);
    view_tabs_->setTabToolTip(view_tabs_->addTab(title), tip);
  };
  add(splat_, "Splats", "The Gaussians, lit or by channel (Ctrl+1)");
  add(images_, "Images", "Photographs and maps, two under a wipe (Ctrl+2)");
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
  auto* display = new DisplayPanel(*splat_, lights_);
  connect(display, &DisplayPanel::openLightWanted, this, &MainWindow::openLight);
  auto* inspector = new QTabWidget;
  inspector->setDocumentMode(true);
  inspector->tabBar()->setDrawBase(false);
  inspector->addTab(display, "Display");
  inspector->addTab(settings_, "Settings");
  connect(rail_, &StageRail::chosen, this, [this, inspector](const std::string& stage) {
    if (!settings_->setStage(stage)) rail_->select(settings_->stage());
    inspector->setCurrentWidget(settings_);
  });
  connect(settings_, &SettingsPanel::attentionWanted, inspector,
          [this, inspector] { inspector->setCurrentWidget(settings_); });
  log_ = new LogPanel;
  QDockWidget* left = dock("project", "Project", project_panel_, Qt::LeftDockWidgetArea);
  QDockWidget* right = dock("inspector", "Inspector", inspector, Qt::RightDockWidgetArea);
  QDockWidget* bottom = dock("log", "Log", log_, Qt::BottomDockWidgetArea);
  resizeDocks({left, right}, {280, 340}, Qt::Horizontal);
  timeline_ = new TimelinePanel(model_, player_);
  QDockWidget* timeline = dock("timeline", "Timeline", timeline_, Qt::BottomDockWidgetArea);
  tabifyDockWidget(timeline, bottom);
  timeline->raise();
  resizeDocks({timeline}, {235}, Qt::Vertical);
  settings_->setStage(rail_->selected());
  reading_ = new QLabel;
  state_words_ = new QLabel;
  statusBar()->addWidget(reading_, 1);
  statusBar()->addPermanentWidget(state_words_);
  statusBar()->setSizeGripEnabled(false);
}

void MainWindow::showView(StudioView view) {
  view_tabs_->setCurrentIndex(static_cast<int>(view));
  QWidget* const widgets[] = {splat_, &images_->view(), scene_};
  widgets[static_cast<int>(view)]->setFocus();
}

StudioView MainWindow::shownView() const { return static_cast<StudioView>(views_->currentIndex()); }

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
  if (sample_.busy() || !model_.settled() || !lights_.settled()) return false;
  return !model_.isOpen() || viewSettled();
}

void MainWindow::open(const fs::path& path) {
  if (isPanorama(path)) {
    lights_.add(path);
    return;
  }
  if (job_.busy()) {
    say("A run is going on", "Cancel it or wait for its end, then open another project.");
    return;
  }
  model_.open(path);
}

// Keys that no text field or list took go to the view that is seen.
void MainWindow::keyPressEvent(QKeyEvent* event) {
  bool taken = false;
  if (centre_->currentIndex() == 1) {
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
  if (layout_ == Layout::Remembered) {
    QSettings settings;
    settings.setValue("geometry", saveGeometry());
    settings.setValue("docks", saveState());
    settings.setValue("view", views_->currentIndex());
  }
  job_.requestStop();
  sample_.requestStop();
  event->accept();
}

void MainWindow::restoreLayout() {
  const QSettings settings;
  restoreGeometry(settings.value("geometry").toByteArray());
  restoreState(settings.value("docks").toByteArray());
  view_tabs_->setCurrentIndex(settings.value("view", 0).toInt());
}

void MainWindow::remember(const QString& folder) {
  if (layout_ != Layout::Remembered) return;
  constexpr int kMost = 6;
  QSettings settings;
  QStringList recent = settings.value("recent").toStringList();
  recent.removeAll(folder);
  recent.prepend(folder);
  while (recent.size() > kMost) recent.removeLast();
  settings.setValue("recent", recent);
  start_->setRecent(recent);
}

void MainWindow::say(const QString& title, const QString& text) {
  message_->show(MessagePanel::Kind::Error, title, text);
  log_->add(LogLevel::Error, title + ": " + text);
}

}  // namespace beam
