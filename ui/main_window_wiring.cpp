// SPDX-License-Identifier: Apache-2.0
// Who hears whom: model to panels and views, views to panels, job to everything.
#include <QRegularExpression>
#include <QStackedWidget>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/stages/relight_settings.h"
#include "ui/display_panel.h"
#include "ui/elided_label.h"
#include "ui/image_page.h"
#include "ui/log_panel.h"
#include "ui/main_window.h"
#include "ui/message_panel.h"
#include "ui/project_panel.h"
#include "ui/run_bar.h"
#include "ui/stage_rail.h"
#include "ui/start_page.h"
#include "ui/timeline_panel.h"
#include "ui/words.h"
#include "viewers/image/image_view.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

QString staleWords(const FrameValues& values) {
  return values.stale ? "stale: " + QString::fromStdString(values.stale_note) : QString();
}

}  // namespace

void MainWindow::connectModel() {
  connect(&model_, &ProjectModel::openingStarted, this, [this](const QString& path) {
    reading_->setText("Opening " + path);
    refreshCommands();
  });
  connect(&model_, &ProjectModel::opened, this, &MainWindow::showOpened);
  connect(&model_, &ProjectModel::closed, this, &MainWindow::showClosed);
  connect(&model_, &ProjectModel::failed, this, [this](const QString& what, const QString& why) {
    reading_->setText({});
    say(what, why);
    refreshCommands();
  });
  connect(&model_, &ProjectModel::anotherCapture, this, [this](const QString& folder, const QString& how) {
    reading_->setText({});
    refreshCommands();
    askForAnotherCapture(folder, how);
  });
  connect(&model_, &ProjectModel::broken, this, [this](const QString& folder, const QString& why) {
    reading_->setText({});
    broken_ = folder.toStdString();
    refreshCommands();
    say("The project cannot be read", why, commands_.action("earlier_versions"));
  });
  connect(&model_, &ProjectModel::stagesChanged, this, [this] {
    showStages();
    askForecast();
  });
  connect(&model_, &ProjectModel::valuesChanged, this, &MainWindow::showValues);
  connect(&model_, &ProjectModel::settingsChanged, this, [this] {
    if (model_.isOpen()) keepRecent();  // the first save
    showTitle();
    refreshCommands();
    splat_->setLighting(lighting());
    lightImages();
  });
  connect(&model_, &ProjectModel::frameChanged, this, [this] {
    splat_->setCapture(model_.capture(), model_.frame());
    if (preview_.cloud) showSplats();  // another frame's preview does not stay
    showStatus();
  });
  connect(&player_, &Player::rangeChanged, this, [this] {
    refreshCommands();
    askForecast();
  });
  connect(&forecast_, &RunForecast::told, this, &MainWindow::showForecast);
  connect(&lights_, &LightLibrary::lightChanged, this, [this] {
    splat_->setLight(lights_.light(), lights_.name(), lights_.reading());
    lightImages();
  });
  connect(&lights_, &LightLibrary::failed, this,
          [this](const QString& what, const QString& why) { say(what, why); });
}

void MainWindow::connectWatch() {
  connect(&watch_, &CaptureWatch::lost, this, [this] {
    if (model_.captureLost()) return;
    model_.setCaptureThere(false);
    showCaptureLost();
  });
  connect(&watch_, &CaptureWatch::back, this, [this] {
    message_->hide();
    // A project that was opened without it knows only what its results tell of it.
    model_.project().withoutCapture() ? model_.open(model_.project().folder()) : model_.setCaptureThere(true);
    refreshCommands();
  });
  connect(&watch_, &CaptureWatch::checked, this, [this](const QStringList& warnings) {
    for (const QString& warning : warnings) warn(warning);
  });
  connect(&problems_, &ProblemList::changed, this, &MainWindow::showProblems);
}

// By the words of the message, which names what it is about.
Problem MainWindow::problemOf(Problem::Kind kind, const QString& text) const {
  Problem problem{.kind = kind, .text = text};
  static const QRegularExpression kCamera("camera (\\S+?)[,;:.]?(\\s|$)"),
      kFrame("frame (\\S+?)[,;:.]?(\\s|$)");
  if (model_.capture()) {
    const QString camera = kCamera.match(text).captured(1), frame = kFrame.match(text).captured(1);
    for (const View& view : model_.capture()->views) {
      if (view.name == camera.toStdString()) problem.camera = view.name;
    }
    for (FrameIndex f{0}; f.value < model_.frameCount(); ++f.value) {
      if (model_.nameOf(f) == frame) problem.frame = frame;
    }
  }
  problem.stage = run_.running_stage;
  return problem;
}

void MainWindow::warn(const QString& text) {
  log_->add(LogLevel::Warning, text);
  problems_.add(problemOf(Problem::Kind::Warning, text));
}

void MainWindow::showProblems() {
  rail_->setWarnings(problems_.countsByStage());
  project_panel_->setProblems(problems_.textsByCamera());
}

void MainWindow::connectViews() {
  connect(views_, &QStackedWidget::currentChanged, this, [this] {
    // Light and exposure may be others since; and a view that is not seen does not follow the frames.
    if (shownView() == StudioView::Image) lightImages();
    display_->setShown(shownView());
    showValuesIn(shownView());
    refreshCommands();
  });
  connect(scene_, &SceneView::jointPicked, &joints_, &JointSource::pick);
  connect(&joints_, &JointSource::changed, this, [this] {
    const JointsShown& shown = joints_.shown();
    scene_->setJoints(shown.trails, shown.hint);
    scene_->setInfluence(shown.influence ? joints_.picked() : -1, shown.influence);
  });
  connect(splat_, &SplatView::hovered, reading_, &ElidedLabel::setText);
  connect(splat_, &SplatView::pictureShown, this, &MainWindow::showStatus);
  connect(&images_->view(), &ImageView::hovered, reading_, &ElidedLabel::setText);
  connect(&images_->view(), &ImageView::exposureChanged, splat_, &SplatView::setExposure);
  // Every move of the hand tells of a state; of what it holds only the channel matters to commands, which
  // look at the disk.
  connect(splat_, &SplatView::stateChanged, this,
          [this, channel = splat_->state().channel](const ViewState& state) mutable {
            if (std::exchange(channel, state.channel) != state.channel) commands_.refresh();
            if (shownView() == StudioView::Image) lightImages();
            if (state.look_through == looked_through_) return;
            looked_through_ = state.look_through;
            if (looked_through_) showCamera(*looked_through_);
          });
  connect(scene_, &SceneView::cameraPicked, this, &MainWindow::showCamera);
  connect(scene_, &SceneView::cameraActivated, splat_, &SplatView::lookThrough);  // which shows it
  connect(images_, &ImagePage::cameraChosen, this, &MainWindow::showCamera);
  connect(project_panel_, &ProjectPanel::cameraChosen, this, &MainWindow::showCamera);
  connect(project_panel_, &ProjectPanel::cameraActivated, this, [this](ViewIndex view) {
    showCamera(view);
    shownView() == StudioView::Scene ? scene_->lookThrough(view) : splat_->lookThrough(view);
  });
}

// One camera is the chosen one in the list and in all views.
void MainWindow::showCamera(ViewIndex view) {
  const View& camera = model_.capture()->views[static_cast<std::size_t>(view.value)];
  reading_->setText(QString("Camera %1, %2: a double click looks through it")
                        .arg(QString::fromStdString(camera.name),
                             camera.split == Split::Test ? "held out" : "for training"));
  project_panel_->mark(view);
  scene_->markCamera(view);
  images_->choose(view);
}

void MainWindow::connectJob() {
  connect(&job_, &JobBridge::stageStarted, this,
          [this](const StageStarted& stage) { showRunning(stage.stage, stage.frame); });
  connect(&job_, &JobBridge::progressed, this, [this](const StepProgress& progress) {
    run_bar_->showProgress(progress);
    showRunning(std::string(progress.ref.step.stage()), progress.ref.frame);
    rail_->setRunning(std::string(progress.ref.step.stage()), progress.report.fraction);
  });
  connect(&job_, &JobBridge::stepFinished, this, [this] { model_.refresh(); });
  connect(&job_, &JobBridge::stepFailed, this, [this](const StepFailed& failure) {
    say(QString("Frame %1 failed at %2")
            .arg(QString::fromStdString(failure.ref.frame_name),
                 stepTitle(services_.pipeline->stages.infos(), failure.ref.step)),
        QString::fromStdString(failure.message));
    model_.refresh();
  });
  const auto note = [this](const QString& text) {
    problems_.add(
        problemOf(Problem::Kind::Warning, withStepTitles(services_.pipeline->stages.infos(), text)));
  };
  connect(&job_, &JobBridge::warned, this, note);  // the log has it from where it was said
  connect(log_, &LogPanel::warned, this, [this, note](const QString& text) {
    if (!job_.busy()) note(text);  // a run tells of its own
  });
  connect(&job_, &JobBridge::waiting, this, [this](const JobWaiting& waiting) {
    run_bar_->showWaiting(QString("waits for %1, which %2 computes")
                              .arg(waiting.ref.frame
                                       ? "frame " + QString::fromStdString(waiting.ref.frame_name)
                                       : stepTitle(services_.pipeline->stages.infos(), waiting.ref.step),
                                   QString::fromStdString(waiting.holder)));
  });
  connect(&job_, &JobBridge::previewChanged, this, &MainWindow::takePreview);
  connect(&job_, &JobBridge::finished, this, &MainWindow::showFinished);
}

void MainWindow::connectTask() {
  connect(&task_, &BackgroundTask::progressed, run_bar_, &RunBar::showReport);
  connect(&task_, &BackgroundTask::done, this, [this] {
    stopping_ = false;
    run_bar_->showFinished(task_words_ + " is ready");
    refreshCommands();
  });
  connect(&task_, &BackgroundTask::failed, this, [this](const QString& why) {
    stopping_ = false;
    run_bar_->showFinished(why.isEmpty() ? "Cancelled" : task_words_ + " was not made");
    if (!why.isEmpty()) say(task_words_ + " was not made", why);
    refreshCommands();
  });
  connect(start_, &StartPage::recentChosen, this,
          [this](const QString& folder) { open(folder.toStdString()); });
}

void MainWindow::connectPlayer() {
  connect(&player_, &Player::playingChanged, this, &MainWindow::showPlaying);
  connect(splat_, &SplatView::pictureShown, &player_, &Player::poll);
  connect(&images_->view(), &ImageView::pictureShown, &player_, &Player::poll);
}

void MainWindow::showPlaying() {
  if (!player_.playing()) {
    splat_->setPassing(0);
    timeline_->setPictureNote({});
    showStages();
    askForecast();
    return showValues();
  }
  const double interval_ms = 1000 / player_.clock().takeRate();
  const int divisor = full_size_play_ ? 1
                                      : playDivisor(splat_->fullPictureMilliseconds(),
                                                    splat_->halfPictureMilliseconds(), interval_ms);
  splat_->setPassing(divisor);
  timeline_->setPictureNote(shownView() != StudioView::Splat || divisor == 1 ? QString()
                            : divisor == 2                                   ? "half size"
                                                                             : "quarter size");
}

void MainWindow::showValues() {
  if (player_.playing()) {
    showPlaying();  // the size may have to change
    return showValuesIn(shownView());
  }
  for (const StudioView view : {StudioView::Splat, StudioView::Image, StudioView::Scene}) showValuesIn(view);
  showStatus();
}

void MainWindow::showValuesIn(StudioView view) {
  if (!model_.isOpen()) return;
  const FrameValues& values = model_.values();
  switch (view) {
    case StudioView::Splat:
      return showSplats();
    case StudioView::Image:
      return images_->refresh();
    case StudioView::Scene:
      scene_->setCloud(previewWins() ? preview_.cloud : values.cloud);
      scene_->setMesh(values.mesh);
      if (shownView() == StudioView::Scene) joints_.refresh();
  }
}

Lighting MainWindow::lighting() const {
  return model_.isOpen() ? plainLighting(model_.project()) : Lighting{};
}

// As the splat view is lit and exposed; both scale photographs and renders alike.
void MainWindow::lightImages() {
  const ViewState& state = splat_->state();
  images_->setLight({lights_.light(), state.yaw_rad, lights_.reading(), lights_.name(), lighting()});
  images_->view().setExposure(state.exposure_stops);
}

void MainWindow::showSplats() {
  if (!model_.isOpen()) return;
  splat_->setLighting(lighting());
  const FrameValues& values = model_.values();
  images_->view().setBadge(staleWords(values));  // which shows neither previews nor held frames
  if (previewWins()) {
    splat_->setBadge(preview_.live ? "live preview" : "preview of the run that was stopped");
    FrameValues seen;
    seen.cloud = preview_.cloud;
    return splat_->setScene(
        instancesOf(seen),
        QString("frame %1 · %2").arg(model_.frameName(), countText(preview_.cloud->size(), "Gaussian")));
  }
  if (const auto& held = model_.held()) {
    const QString from = model_.nameOf(held->from);
    splat_->setBadge(staleWords(held->values));
    return splat_->setScene(instancesOf(held->values),
                            QString("frame %1 is not solved: held from %2").arg(model_.frameName(), from));
  }
  splat_->setBadge(staleWords(values));
  splat_->setScene(instancesOf(values),
                   "frame " + model_.valuesFrameName() + (values.interpolated ? ", interpolated" : ""));
}

void MainWindow::showStages() {
  if (player_.playing()) return;  // at rest it is told of the frame that is looked at, too
  rail_->setStages(model_.stages());
  refreshCommands();
  images_->refresh();
  if (shownView() == StudioView::Scene) joints_.refresh();
}

void MainWindow::showTitle() {
  if (!model_.isOpen()) return setWindowTitle("BEAM Studio");
  setWindowTitle(
      QString("%1%2 · BEAM Studio")
          .arg(QString::fromStdString(model_.project().name()), model_.unsaved() ? " (not saved)" : ""));
}

void MainWindow::showStatus() {
  QStringList parts;
  if (model_.isOpen())
    parts << "frame " + model_.frameName() + (model_.values().interpolated ? ", interpolated" : "");
  if (model_.values().cloud) {
    parts << QString("drawn in %1 ms").arg(numberText(std::llround(splat_->fullPictureMilliseconds())));
  }
  parts << QString::fromStdString(splat_->abilities().title);
  state_words_->setText(parts.join("   ·   "));
}

}  // namespace beam
