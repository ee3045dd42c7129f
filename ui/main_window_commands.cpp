// SPDX-License-Identifier: Apache-2.0
// What can be done, its words and keys, and why it cannot be done now.
#include <QApplication>
#include <QDockWidget>
#include <QMenuBar>
#include <QMessageBox>
#include <QTabBar>

#include <algorithm>
#include <cmath>

#include "core/stages/project_sequence.h"
#include "ui/elided_label.h"
#include "ui/image_page.h"
#include "ui/main_window.h"
#include "ui/run_bar.h"
#include "ui/start_page.h"
#include "viewers/image/image_view.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

const char* const kKeys =
    "<h3>Keys of the views</h3><table cellpadding=4>"
    "<tr><td><b>1 … 7</b></td><td>Lit, radiance, base colour, ambient occlusion, roughness, normal, "
    "depth</td></tr>"
    "<tr><td><b>C · M</b></td><td>next channel · back to Lit</td></tr>"
    "<tr><td><b>left · middle · wheel</b></td><td>orbit · pan · zoom to the pointer</td></tr>"
    "<tr><td><b>double click</b></td><td>orbit around that point; on a camera: look through it</td></tr>"
    "<tr><td><b>F · H</b></td><td>the subject fills the view · home</td></tr>"
    "<tr><td><b>number pad 1 · 3 · 7</b></td><td>from the front · right · top; with Ctrl the "
    "opposite</td></tr>"
    "<tr><td><b>Shift + right drag</b></td><td>turn the light</td></tr>"
    "<tr><td><b>E · Shift+E · R</b></td><td>exposure up · down half a stop · reset</td></tr>"
    "<tr><td><b>[ · ]</b></td><td>previous · next camera</td></tr>"
    "<tr><td><b>Enter · Esc</b></td><td>look through a camera · leave it; the wheel fades the "
    "photograph</td></tr>"
    "<tr><td><b>W · D · T · hold Shift</b></td><td>images: wipe · difference · swap sides · B alone</td></tr>"
    "<tr><td><b>K · G · J</b></td><td>scene: cameras · grid · joints</td></tr>"
    "<tr><td><b>Space · ← · →</b></td><td>play or pause · previous · next frame</td></tr>"
    "<tr><td><b>I · O · Home · End · L</b></td><td>in point here · out point here · to them · loop</td></tr>"
    "<tr><td><b>Ctrl+Enter · Ctrl+.</b></td><td>run · cancel</td></tr></table>";

const char* const kWhatItIs =
    "Turns multi-view photographs of a person in a lit dome into Gaussians that can be relit.";

// Of the settings in force, in any frame.
bool hasResults(const TakeSurvey& survey) {
  const auto known = [](double v) { return !std::isnan(v); };
  const auto has = [&](const SurveyCurve& c) { return std::any_of(c.values.begin(), c.values.end(), known); };
  const auto failed = [](const SurveyLane& l) {
    return std::find(l.cells.begin(), l.cells.end(), CellState::Failed) != l.cells.end();
  };
  return std::any_of(survey.curves.begin(), survey.curves.end(), has) ||
         std::any_of(survey.lanes.begin(), survey.lanes.end(), failed);
}

// One that is not on disk yet can be written, wherever it is to lie.
bool cannotBeWritten(const Project& project) {
  return Project::isProject(project.folder()) && project.readOnly();
}

}  // namespace

// --- Why something cannot be done now; empty: it can ---

QString MainWindow::refusalToOpen() const {
  if (job_.busy()) return "A run is going on: cancel it or wait for its end.";
  if (task_.busy()) return task_words_ + " is being made.";
  if (model_.opening()) return "A project is being opened.";
  return {};
}

QString MainWindow::refusalToSample() const {
  return services_.make_sample ? refusalToOpen() : "This program comes without a sample.";
}

QString MainWindow::refusalWithoutProject() const {
  return model_.isOpen() ? QString() : "Open a capture or a project first.";
}

QString MainWindow::refusalToRun() const {
  if (const QString why = refusalToOpen(); !why.isEmpty()) return why;
  if (const QString why = refusalWithoutProject(); !why.isEmpty()) return why;
  if (model_.captureLost()) return "The capture is not where it was: locate it first.";
  if (cannotBeWritten(model_.project()))
    return "The project is read-only: make its folder writable, or save it as another one.";
  return {};
}

QString MainWindow::refusalToWork() const {
  if (const QString why = refusalToOpen(); !why.isEmpty()) return why;
  if (const QString why = refusalWithoutProject(); !why.isEmpty()) return why;
  if (model_.captureLost()) return "The capture is not where it was: locate it first.";
  return model_.survey() ? QString() : "The project is still being looked through.";
}

QString MainWindow::refusalToEvaluate() const {
  if (const QString why = refusalToWork(); !why.isEmpty()) return why;
  if (!held_out_)
    return "No held-out camera has photographs of its own: a new project can keep some cameras out of the "
           "fit.";
  if (!anySolved(*model_.survey())) return "No frame is solved yet: run one first.";
  if (cannotBeWritten(model_.project())) return "The project is read-only: its scores could not be kept.";
  return {};
}

QString MainWindow::refusalToReport() const {
  if (const QString why = refusalToWork(); !why.isEmpty()) return why;
  return hasResults(*model_.survey()) ? QString() : "No frame has a result yet: run one first.";
}

QString MainWindow::refusalToStop() const {
  if (stopping_) return "The run is stopping.";
  return job_.busy() || task_.busy() ? QString() : "Nothing is running.";
}

bool MainWindow::showsNoGaussians() const {
  return !model_.values().cloud && !model_.held() && !preview_.cloud;
}

QString MainWindow::refusalToSavePicture() const {
  if (const QString why = refusalWithoutProject(); !why.isEmpty()) return why;
  return shownView() == StudioView::Splat && showsNoGaussians() ? "There are no Gaussians to show yet."
                                                                : QString();
}

// --- The commands ---

void MainWindow::makeCommands() {
  addFileCommands();
  addProcessCommands();
  addWorkCommands();
  addViewCommands();
  commands_.add("keys", {"Keys", "Keys and mouse of the views", QKeySequence("F1"),
                         [this] { QMessageBox::information(this, "Keys", kKeys); }});
  commands_.add(
      "about",
      {"About", "The program and its version", {}, [this] {
         QMessageBox::about(
             this, "BEAM Studio",
             QString("BEAM Studio %1\n%2").arg(QString::fromStdString(services_.version), kWhatItIs));
       }});
}

void MainWindow::addFileCommands() {
  const auto to_open = [this] { return refusalToOpen(); };
  const auto with_project = [this] { return refusalWithoutProject(); };
  commands_.add("new_project", {"New project…", "Choose a capture, and where its project is to lie",
                                QKeySequence("Ctrl+Shift+N"), [this] { newProject(); }, to_open});
  commands_.add("open_capture", {"Open capture…", "Open a folder of photographs; its project lies beside it",
                                 QKeySequence("Ctrl+N"), [this] { openCapture(); }, to_open});
  commands_.add("open_project", {"Open project…", "Open a folder that ends in .beam", QKeySequence("Ctrl+O"),
                                 [this] { openProject(); }, to_open});
  commands_.add("open_sample",
                {"Open sample",
                 "A small made-up capture with known truth; the first time it is made, which takes "
                 "a minute or two",
                 {},
                 [this] { openSample(); },
                 [this] { return refusalToSample(); }});
  commands_.add("open_light", {"Open panorama…", "Light with a panorama, .exr or .hdr",
                               QKeySequence("Ctrl+L"), [this] { openLight(); }, with_project});
  commands_.add("capture_light",
                {"Light of the capture…",
                 "The panorama of the light that the photographs were taken in; Light and Materials need it",
                 {},
                 [this] { chooseCaptureLight(); },
                 [this] {
                   const QString why = refusalWithoutProject();
                   return why.isEmpty() && model_.project().readOnly() ? QString("The project is read-only.")
                                                                       : why;
                 }});
  commands_.add("save_settings", {"Save settings", "Write the settings into the project now",
                                  QKeySequence("Ctrl+S"), [this] { saveSettings(); },
                                  [this] {
                                    if (!model_.isOpen()) return refusalWithoutProject();
                                    return cannotBeWritten(model_.project())
                                               ? QString("The project is read-only.")
                                               : QString();
                                  }});
  commands_.add("save_as",
                {"Save as…", "A copy of the project with all its results under another name; it is opened",
                 QKeySequence("Ctrl+Shift+S"), [this] { saveAs(); },
                 [this] {
                   const QString why = refusalWithoutProject();
                   if (!why.isEmpty()) return why;
                   if (!Project::isProject(model_.project().folder()))
                     return QString("The project is not on disk yet: save it first.");
                   return refusalToOpen();
                 }});
  commands_.add("locate_capture", {"Locate capture…",
                                   "Say where the folder of the capture is now",
                                   {},
                                   [this] { locateCapture(); },
                                   [this] {
                                     if (const QString why = refusalWithoutProject(); !why.isEmpty())
                                       return why;
                                     if (!model_.captureLost())
                                       return QString("The capture is where it was.");
                                     return refusalToOpen();
                                   }});
  commands_.add("earlier_versions",
                {"Earlier versions…",
                 "Settings as they were saved before; results stay",
                 {},
                 [this] { chooseVersion(broken_.empty() ? model_.project().folder() : broken_); },
                 [this] {
                   if (!broken_.empty()) return refusalToOpen();
                   if (const QString why = refusalWithoutProject(); !why.isEmpty()) return why;
                   if (!Project::isProject(model_.project().folder()))
                     return QString("The project is not on disk yet.");
                   if (model_.project().readOnly()) return QString("The project is read-only.");
                   return refusalToOpen();
                 }});
  commands_.add("save_picture",
                {"Save picture…", "The view with its labels as a PNG file", QKeySequence("F12"),
                 [this] { savePicture(); }, [this] { return refusalToSavePicture(); }});
  commands_.add("close_project", {"Close project", "Back to the start page", QKeySequence("Ctrl+W"),
                                  [this] { closeProject(); },
                                  [this] {
                                    const QString why = refusalWithoutProject();
                                    return why.isEmpty() ? refusalToOpen() : why;
                                  }});
  commands_.add("quit", {"Quit", "Leave the program", QKeySequence("Ctrl+Q"), [this] { close(); }});
}

void MainWindow::addProcessCommands() {
  const auto to_run = [this] { return refusalToRun(); };
  commands_.add("run_frame", {"Run this frame", "Compute what is missing of the shown frame",
                              QKeySequence("Ctrl+Return"), [this] { run(); }, to_run});
  commands_.add("run_range", {"Run in–out range", "Compute what is missing from the in to the out point",
                              QKeySequence("Ctrl+Alt+Return"), [this] { run({}, RunScope::Range); }, to_run});
  commands_.add("scout",
                {"Scout in–out range…",
                 "Solve only every so manieth frame of the range for a first look; the frames between are "
                 "interpolated",
                 QKeySequence("Ctrl+Alt+S"), [this] { scout(); },
                 [this] {
                   const QString why = refusalToRun();
                   if (!why.isEmpty()) return why;
                   return player_.range().size() < 3
                              ? QString("Scouting needs an in–out range of three frames or more.")
                              : QString();
                 }});
  commands_.add("run_take", {"Run whole take", "Compute what is missing of all frames",
                             QKeySequence("Ctrl+Shift+Return"), [this] { run({}, RunScope::Take); }, to_run});
  for (const StageInfo& stage : services_.pipeline->stages.infos()) {
    const QString title = QString::fromStdString(stage.title);
    commands_.add("until_" + QString::fromStdString(stage.id),
                  {.text = "This frame until " + title,
                   .tip = "Compute what is missing of the shown frame, and end when " + title + " is done",
                   .act = [this, id = stage.id] { run(id); },
                   .refusal = to_run});
  }
  const auto later_stop = [&](const char* id, const char* text, const char* tip, StopAfter what) {
    commands_.add(id, {.text = text,
                       .tip = tip,
                       .act = [this, what] { stopAfter(what); },
                       .refusal =
                           [this] {
                             if (!job_.busy()) return QString("No run is going on.");
                             return refusalToStop();
                           }});
  };
  later_stop("stop_after_step", "Stop after this step",
             "The step at work is finished and kept, then the run ends", StopAfter::Step);
  later_stop("stop_after_frame", "Stop after this frame",
             "The frame at work is finished and kept, then the run ends", StopAfter::Frame);
  commands_.add("cancel", {"Cancel", "Stop now; finished steps are kept", QKeySequence("Ctrl+."),
                           [this] { cancelRun(); }, [this] { return refusalToStop(); }});
}

void MainWindow::addWorkCommands() {
  commands_.add("evaluate", {"Evaluate",
                             "Score the solved frames by the photographs of held-out cameras, which no fit "
                             "has seen; the scores stand in the panel Project",
                             {},
                             [this] { evaluateHeldOut(); },
                             [this] { return refusalToEvaluate(); }});
  commands_.add("report", {"Report…",
                           "Write the quality of all frames as one page: curves, cameras, worst frames, "
                           "pictures",
                           {},
                           [this] { writeReport(); },
                           [this] { return refusalToReport(); }});
}

void MainWindow::addViewCommands() {
  const auto with_project = [this] { return refusalWithoutProject(); };
  const auto view = [&](const char* id, const char* text, const char* keys, StudioView which) {
    commands_.add(id, {.text = text,
                       .tip = QString("Show the view %1").arg(text),
                       .keys = QKeySequence(keys),
                       .act = [this, which] { showView(which); },
                       .refusal = with_project,
                       .group = "view",
                       .chosen = [this, which] { return shownView() == which; }});
  };
  view("view_splat", "Splats", "Ctrl+1", StudioView::Splat);
  view("view_image", "Images", "Ctrl+2", StudioView::Image);
  view("view_scene", "Scene", "Ctrl+3", StudioView::Scene);
  for (const ChannelInfo& channel : shownChannels()) {
    const QString title = QString::fromStdString(channel.title);
    // The digit is told, not bound: letters and digits belong to the view that has the focus.
    commands_.add(QString::fromStdString("channel_" + channel.id),
                  {.text = QString("%1\t%2").arg(title).arg(channel.key),
                   .tip = QString("Splat view: %1, %2").arg(title, QString::fromStdString(channel.legend)),
                   .act =
                       [this, channel] {
                         splat_->setChannel(channel);
                         showView(StudioView::Splat);
                       },
                   .refusal = with_project,
                   .group = "channel",
                   .chosen = [this, channel] { return splat_->state().channel == channel; }});
  }
  addCameraCommands();
  addLookCommands();
  commands_.add("reset_layout", {.text = "Reset layout",
                                 .tip = "Panels where they were when the program was new",
                                 .act = [this] { resetLayout(); },
                                 .refusal = with_project});
  commands_.add("full_screen", {.text = "Full screen",
                                .tip = "The window over the whole screen, and back",
                                .keys = QKeySequence("F11"),
                                .act = [this] { toggleFullScreen(); }});
}

QString MainWindow::refusalToMoveCamera() const {
  if (const QString why = refusalWithoutProject(); !why.isEmpty()) return why;
  if (shownView() == StudioView::Image) return "The view Images has no camera to move.";
  return shownView() == StudioView::Splat && showsNoGaussians() ? "There are no Gaussians to look at yet."
                                                                : QString();
}

void MainWindow::addCameraCommands() {
  const auto refusal = [this] { return refusalToMoveCamera(); };
  const auto in_scene = [this] { return shownView() == StudioView::Scene; };
  struct Direction {
    const char *id, *text;
    ViewPreset preset;
  };
  for (const Direction& d : {Direction{"front", "Front\tNum 1", ViewPreset::Front},
                             {"back", "Back\tCtrl+Num 1", ViewPreset::Back},
                             {"right", "Right\tNum 3", ViewPreset::Right},
                             {"left", "Left\tCtrl+Num 3", ViewPreset::Left},
                             {"top", "Top\tNum 7", ViewPreset::Top},
                             {"bottom", "Bottom\tCtrl+Num 7", ViewPreset::Bottom}}) {
    const auto look = [this, in_scene, d] {
      in_scene() ? scene_->setPreset(d.preset) : splat_->setPreset(d.preset);
      reading_->setText("Seen from the " + QString(d.id));
    };
    commands_.add(QString("look_") + d.id,
                  {.text = d.text, .tip = "Look at the subject from there", .act = look, .refusal = refusal});
  }
  commands_.add("frame_subject", {.text = "Frame the subject\tF",
                                  .tip = "The subject fills the view; the direction stays",
                                  .act =
                                      [this, in_scene] {
                                        in_scene() ? scene_->frameSubject() : splat_->frameSubject();
                                        reading_->setText("The subject fills the view");
                                      },
                                  .refusal = refusal});
  commands_.add("go_home", {.text = "Home\tH",
                            .tip = "The view as it was at first",
                            .act =
                                [this, in_scene] {
                                  in_scene() ? scene_->goHome() : splat_->goHome();
                                  reading_->setText("The view as it was at first");
                                },
                            .refusal = refusal});
}

void MainWindow::addLookCommands() {
  for (const int percent : {100, 125, 150}) {
    commands_.add(QString("text_%1").arg(percent),
                  {.text = QString("%1 %").arg(percent),
                   .tip = QString("All text of the window at %1 % of its usual size").arg(percent),
                   .act = [this, percent] { chooseLook(look_.theme, percent); },
                   .group = "text",
                   .chosen = [this, percent] { return look_.text_percent == percent; }});
  }
  struct Choice {
    const char *id, *text, *tip;
    Theme theme;
  };
  for (const Choice& c :
       {Choice{"theme_system", "As the system", "Light or dark as the desktop is", Theme::System},
        {"theme_dark", "Dark", "Pictures are the brightest thing on the screen", Theme::Dark},
        {"theme_light", "Light", "For bright rooms", Theme::Light}}) {
    commands_.add(c.id, {.text = c.text,
                         .tip = c.tip,
                         .act = [this, theme = c.theme] { chooseLook(theme, look_.text_percent); },
                         .group = "theme",
                         .chosen = [this, theme = c.theme] { return look_.theme == theme; }});
  }
}

void MainWindow::chooseLook(Theme theme, int text_percent) {
  look_ = {theme, text_percent};
  memory_.keepNumber("theme", static_cast<int>(theme));
  memory_.keepNumber("text_percent", text_percent);
  applyTheme(*qApp, theme, text_percent / 100.0);
}

void MainWindow::resetLayout() {
  restoreState(fresh_state_);
  sizePanels();
  reading_->setText("Panels are where they were at first");
}

void MainWindow::toggleFullScreen() {
  if (!isFullScreen()) {
    was_maximized_ = isMaximized();
    return showFullScreen();
  }
  was_maximized_ ? showMaximized() : showNormal();
}

// --- Menus and buttons over them ---

void MainWindow::makeMenus() {
  const auto menu = [this](const char* title, const std::vector<const char*>& ids) {
    QMenu* made = menus_->addMenu(title);
    made->setToolTipsVisible(true);
    for (const char* id : ids) {
      if (*id == '\0') {
        made->addSeparator();
      } else {
        made->addAction(commands_.action(id));
      }
    }
    return made;
  };
  QMenu* file = menu("&File", {"new_project", "open_capture", "open_project", "open_sample", "open_light",
                               "capture_light", "", "save_settings", "save_as", "earlier_versions",
                               "locate_capture", "save_picture", "", "close_project", "quit"});
  recent_ = new QMenu("Open recent", file);
  recent_->setToolTipsVisible(true);
  file->insertMenu(commands_.action("open_sample"), recent_);
  connect(file, &QMenu::aboutToShow, this, &MainWindow::fillRecent);
  menu("&Process", {"run_frame", "run_range", "scout", "run_take", "", "evaluate", "report", "", "cancel",
                    "stop_after_step", "stop_after_frame"});
  QMenu* view = menu("&View", {"view_splat", "view_image", "view_scene", ""});
  const auto submenu = [&](const char* title, const QStringList& ids) {
    QMenu* made = view->addMenu(title);
    made->setToolTipsVisible(true);
    for (const QString& id : ids) made->addAction(commands_.action(id));
  };
  QStringList channels;
  for (const ChannelInfo& channel : shownChannels())
    channels << QString::fromStdString("channel_" + channel.id);
  submenu("Channel", channels);
  submenu("Camera", {"frame_subject", "go_home", "look_front", "look_back", "look_right", "look_left",
                     "look_top", "look_bottom"});
  submenu("Text size", {"text_100", "text_125", "text_150"});
  submenu("Colours", {"theme_system", "theme_dark", "theme_light"});
  view->addSeparator();
  for (QDockWidget* dock : findChildren<QDockWidget*>()) view->addAction(dock->toggleViewAction());
  view->addAction(commands_.action("reset_layout"));
  view->addAction(commands_.action("full_screen"));
  menu("&Help", {"keys", "about"});

  start_->bind(commands_);
  std::vector<QAction*> runs;
  for (const char* id : {"run_frame", "run_range", "scout", "run_take"}) runs.push_back(commands_.action(id));
  std::vector<QAction*> until;
  for (const StageInfo& stage : services_.pipeline->stages.infos())
    until.push_back(commands_.action("until_" + QString::fromStdString(stage.id)));
  run_bar_->bind(runs, until, commands_.action("cancel"),
                 {commands_.action("stop_after_step"), commands_.action("stop_after_frame")});
  // Shortcuts have to work while their menu has never been opened.
  for (QAction* action : findChildren<QAction*>()) {
    if (!action->shortcut().isEmpty()) addAction(action);
  }
}

void MainWindow::fillRecent() {
  recent_->clear();
  const QString refusal = refusalToOpen();
  const QStringList folders = memory_.recent();
  for (const QString& folder : folders) {
    QAction* action = recent_->addAction(folder, this, [this, folder] { open(folder.toStdString()); });
    const QString why = refusalToReopen(folder, refusal);
    action->setEnabled(why.isEmpty());
    action->setToolTip(why.isEmpty() ? folder : why);
  }
  if (folders.isEmpty()) {
    QAction* none = recent_->addAction("Nothing yet");
    none->setEnabled(false);
    none->setToolTip("Projects that were opened appear here.");
    return;
  }
  recent_->addSeparator();
  recent_->addAction("Clear the list", this, [this] {
    memory_.forgetRecent();
    showRecent();
    reading_->setText("The list of recent projects is empty now");
  });
}

void MainWindow::refreshCommands() {
  commands_.refresh();
  start_->setRefusal(refusalToOpen());
}

}  // namespace beam
