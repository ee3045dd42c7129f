// SPDX-License-Identifier: Apache-2.0
// Opening, saving, closing: what the window asks for and shows of places on disk.
#include <QDateTime>
#include <QFileInfo>
#include <QInputDialog>
#include <QLocale>
#include <QMessageBox>
#include <QPushButton>
#include <QStackedWidget>

#include "core/pipeline/copy_project.h"
#include "core/pipeline/machine_times.h"
#include "core/pipeline/project_history.h"
#include "core/work/evaluate.h"
#include "ui/elided_label.h"
#include "ui/file_dialogs.h"
#include "ui/image_page.h"
#include "ui/log_panel.h"
#include "ui/main_window.h"
#include "ui/message_panel.h"
#include "ui/project_panel.h"
#include "ui/run_bar.h"
#include "ui/sample_folder.h"
#include "ui/settings_panel.h"
#include "ui/stage_rail.h"
#include "ui/start_page.h"
#include "viewers/image/image_view.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr const char *kNotSaved = "The settings were not saved",
                     *kPictureNotSaved = "The picture was not saved";

bool isPanorama(const fs::path& path) { return path.extension() == ".exr" || path.extension() == ".hdr"; }

}  // namespace

void MainWindow::open(const fs::path& path, const fs::path& project) {
  if (isPanorama(path)) {
    if (model_.isOpen()) return lights_.add(path);
    return say("Nothing to light yet", "Open a capture or a project first, then the panorama.");
  }
  if (const QString why = refusalToOpen(); !why.isEmpty()) return say("Cannot open another project now", why);
  if (!takeOverSettings("Another project was not opened") || !settingsMayGo()) return;
  rememberProject();
  // Whole, and without a slash at its end: the list of recent projects holds for any folder.
  model_.open(fs::absolute(path / "").lexically_normal().parent_path(), project);
}

void MainWindow::newProject() {
  const QString capture = askCaptureFolder(this, memory_, "The folder of the capture");
  if (capture.isEmpty()) return;
  const QString name = QFileInfo(capture).fileName() + ".beam";
  const QString project = askNewProject(this, memory_, "Where the project is to lie", name);
  if (!project.isEmpty()) open(capture.toStdString(), project.toStdString());
}

void MainWindow::openCapture() {
  const QString folder = askCaptureFolder(this, memory_, "Open the folder of a capture");
  if (!folder.isEmpty()) open(folder.toStdString());
}

void MainWindow::openProject() {
  const QString folder = askProjectFolder(this, memory_);
  if (!folder.isEmpty()) open(folder.toStdString());
}

void MainWindow::showTaskStarted() {
  run_bar_->showStarted("Making " + task_words_.toLower());
  refreshCommands();
}

void MainWindow::openSample() {
  if (!refusalToSample().isEmpty()) return;
  startTask(
      "The sample", [services = services_](Progress& progress) { makeSampleOnce(services, progress); },
      [this] {
        quick_first_ = true;
        open(sampleFolder());
      });
}

void MainWindow::openLight() {
  const QString file = askPanorama(this, memory_, "Open a panorama of light");
  if (!file.isEmpty()) open(file.toStdString());
}

// Also shown: whether it can be read, and how the performer looks under it, is seen at once.
void MainWindow::chooseCaptureLight() {
  const QString file = askPanorama(this, memory_, "The light that the capture was made in");
  if (file.isEmpty()) return;
  model_.setEnvironment(file.toStdString());
  lights_.add(file.toStdString());
}

// What is typed counts, whether its field was left or not.
bool MainWindow::takeOverSettings(const QString& what_waits) {
  if (!model_.isOpen()) return true;
  const std::optional<QString> trouble = settings_->takeOver();
  if (!trouble) return true;
  inspector_->setCurrentWidget(settings_);
  say(what_waits, *trouble + " Esc in the field takes back what was typed.");
  return false;
}

// Settings of a project on disk are written; those that are nowhere on disk are asked for.
bool MainWindow::settingsMayGo() {
  if (!asks_before_closing_ || !model_.isOpen() || !model_.editsUnsaved()) return true;
  if (model_.onDisk() && model_.save()) return true;
  QMessageBox question(QMessageBox::Question, "Settings are not saved",
                       QString("Settings of \"%1\" were changed and are not on disk.")
                           .arg(QString::fromStdString(model_.project().name())),
                       QMessageBox::NoButton, this);
  question.setObjectName("unsaved_question");
  QPushButton* save = question.addButton("Save", QMessageBox::AcceptRole);
  QPushButton* discard = question.addButton("Discard the changes", QMessageBox::DestructiveRole);
  question.setDefaultButton(save);
  question.setEscapeButton(question.addButton(QMessageBox::Cancel));
  question.exec();
  if (question.clickedButton() == save) return model_.save();
  return question.clickedButton() == discard;
}

void MainWindow::saveSettings() {
  if (!takeOverSettings(kNotSaved) || !model_.save()) return;
  reading_->setText("Settings saved");
  unsay({kNotSaved, kProjectNotSaved});
  model_.refresh();  // its folder may have been away
}

void MainWindow::saveAs() {
  const QString proposed = QString::fromStdString(model_.project().name()) + " copy.beam";
  const QString folder = askNewProject(this, memory_, "Save a copy of the project", proposed);
  if (folder.isEmpty() || !takeOverSettings("The project was not copied") || !model_.save()) return;
  startTask(
      "The copy",
      [from = model_.project(), to = fs::path(folder.toStdString())](Progress& progress) {
        copyProject(from, to, true, progress);
      },
      [this, folder] {
        const std::string id = readProjectDocument(folder.toStdString()).id;
        memory_.keepFrame(QString::fromStdString(id), model_.frameName());
        open(folder.toStdString());
      });
}

void MainWindow::locateCapture() {
  const QString folder = askCaptureFolder(this, memory_, "Where the capture is now");
  if (!folder.isEmpty()) model_.locateCapture(folder.toStdString());
}

void MainWindow::askForAnotherCapture(const QString& folder, const QString& difference) {
  QMessageBox question(
      QMessageBox::Warning, "Another capture",
      QString("\"%1\" is not the capture of this project: %2.\nResults that do not fit it are "
              "computed anew by the next run.")
          .arg(folder, difference),
      QMessageBox::NoButton, this);
  question.setObjectName("another_capture");
  QPushButton* use = question.addButton("Use it all the same", QMessageBox::AcceptRole);
  QPushButton* choose = question.addButton("Choose another folder…", QMessageBox::ActionRole);
  question.setDefaultButton(choose);
  question.setEscapeButton(question.addButton(QMessageBox::Cancel));
  question.exec();
  if (question.clickedButton() == use) model_.locateCapture(folder.toStdString(), true);
  if (question.clickedButton() == choose) locateCapture();
}

void MainWindow::chooseVersion(const fs::path& folder) {
  const std::vector<HistoryEntry> history = projectHistory(folder);
  QStringList words;
  std::vector<const HistoryEntry*> readable;
  for (const HistoryEntry& entry : history) {
    if (!entry.readable) continue;
    readable.push_back(&entry);
    const auto seconds = std::chrono::system_clock::to_time_t(entry.file_time);
    const QString when = QLocale::c().toString(QDateTime::fromSecsSinceEpoch(seconds), "d MMM yyyy hh:mm:ss");
    words << QString("%1.  %2: %3").arg(words.size() + 1).arg(when, QString::fromStdString(entry.summary));
  }
  if (words.isEmpty())
    return say("No earlier version", "history/ of this project holds none that can be read.");
  bool chosen = false;
  const QString choice = QInputDialog::getItem(
      this, "Earlier versions",
      "Settings as they were saved, newest first. Results stay; the present settings are kept "
      "among the versions.",
      words, 0, false, &chosen);
  if (!chosen) return;
  try {
    restoreProject(folder, *readable[static_cast<std::size_t>(words.indexOf(choice))]);
  } catch (const Error& e) {
    return say("The version was not restored", QString::fromStdString(e.what()));
  }
  open(folder);
}

void MainWindow::savePicture() {
  const char* const names[] = {"splats", "images", "scene"};
  const QString proposed = QString("%1_%2_%3.png")
                               .arg(QString::fromStdString(model_.project().name()), model_.frameName(),
                                    names[static_cast<int>(shownView())]);
  const QString file = askPictureFile(this, memory_, proposed);
  if (file.isEmpty()) return;
  if (!viewPicture().save(file, "PNG"))
    return say(kPictureNotSaved, file + " cannot be written; choose another folder.");
  reading_->setText("Saved " + file);
  unsay({kPictureNotSaved});
}

QImage MainWindow::viewPicture() {
  switch (shownView()) {
    case StudioView::Splat:
      return splat_->picture();
    case StudioView::Image:
      return images_->view().picture();
    case StudioView::Scene:
      return scene_->picture();
  }
  return {};
}

void MainWindow::closeProject() {
  if (!takeOverSettings("The project was not closed") || !settingsMayGo()) return;
  rememberProject();
  model_.close();
}

void MainWindow::rememberProject() {
  keepMachineTimes(forecast_.allTimes());
  if (!model_.isOpen()) return;
  memory_.keepFrame(QString::fromStdString(model_.project().document().id), model_.frameName());
}

// One that was never written could not be opened again.
void MainWindow::keepRecent() {
  const QString folder = QString::fromStdString(model_.project().folder().string());
  if (!model_.onDisk() || memory_.recent().value(0) == folder) return;
  memory_.keepRecent(folder);
  showRecent();
}

void MainWindow::showRecent() { start_->setRecent(memory_.recent()); }

void MainWindow::showCaptureLost() {
  message_->show(MessagePanel::Kind::Error, "The capture is not where it was", model_.lostCaptureText(),
                 commands_.action("locate_capture"));
  problems_.add(
      {.kind = Problem::Kind::Error, .text = "The capture is not where it was.", .stage = "capture"});
  refreshCommands();
}

// What would be lost by closing is asked for; finished steps never are.
bool MainWindow::mayClose() {
  if (!asks_before_closing_) return true;
  if (!takeOverSettings("The window was not closed") || !settingsMayGo()) return false;
  if (!job_.busy()) return true;
  QMessageBox question(
      QMessageBox::Question, "A run is going on",
      "A run is going on. Stop it and close?\nFinished steps are kept; Run goes on from there.",
      QMessageBox::NoButton, this);
  question.setObjectName("close_question");
  QPushButton* stop = question.addButton("Stop and close", QMessageBox::AcceptRole);
  question.addButton("Keep running", QMessageBox::RejectRole);
  question.setDefaultButton(stop);
  question.exec();
  return question.clickedButton() == stop;
}

void MainWindow::showOpened() {
  message_->hide();
  reading_->setText({});
  preview_ = {};
  broken_.clear();
  const Project& project = model_.project();
  keepRecent();
  centre_->setCurrentIndex(1);
  rail_->setEnabled(true);
  showPanels(true);
  run_bar_->showFinished({});
  resetViews();
  problems_.clear();
  log_->add(LogLevel::Info, "Opened " + QString::fromStdString(project.folder().string()));
  if (std::exchange(quick_first_, false) && !Project::isProject(project.folder())) {
    model_.setPreset("draft");
    model_.countAsUnedited();
  }
  if (model_.captureLost()) {
    showCaptureLost();
  } else {
    for (const std::string& warning : project.imported().warnings) warn(QString::fromStdString(warning));
  }
  held_out_ = hasHeldOutPhotographs(project.capture());
  watch_.start(project, services_.check_capture);
  const QString seen = memory_.frameOf(QString::fromStdString(project.document().id));
  model_.startAt(seen);
  try {
    lights_.reset(project.environmentFile().value_or(fs::path()));
  } catch (const Error& e) {
    lights_.reset({});
    say("The panorama is gone", QString::fromStdString(e.what()), commands_.action("capture_light"));
  }
  showTitle();
  showStatus();
  refreshCommands();
  viewWidget()->setFocus();
}

void MainWindow::showClosed() {
  message_->hide();
  reading_->setText({});
  preview_ = {};
  centre_->setCurrentIndex(0);
  rail_->setEnabled(false);
  rail_->setStages(stagesWithoutTake(services_.pipeline->stages.infos()));
  showPanels(false);
  watch_.stop();
  problems_.clear();
  forecast_.forget();
  run_bar_->showFinished({});
  resetViews();
  lights_.reset({});
  showTitle();
  showStatus();
  refreshCommands();
}

// Nothing of another project stays in view.
void MainWindow::resetViews() {
  splat_->setScene({}, {});
  splat_->resetState();
  splat_->setCapture(model_.capture(), model_.frame());
  scene_->setCapture(model_.capture());
  scene_->setCloud(nullptr);
  scene_->setMesh(nullptr);
  images_->reset();
  images_->refresh();
}

}  // namespace beam
