// SPDX-License-Identifier: Apache-2.0
// Who hears whom: model to panels and views, views to panels, job to everything.
#include <QLabel>
#include <QStackedWidget>

#include "ui/image_page.h"
#include "ui/log_panel.h"
#include "ui/main_window.h"
#include "ui/message_panel.h"
#include "ui/project_panel.h"
#include "ui/run_bar.h"
#include "ui/stage_rail.h"
#include "viewers/image/image_view.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {

void MainWindow::connectModel() {
  connect(&model_, &ProjectModel::openingStarted, this,
          [this](const QString& path) { reading_->setText("Opening " + path); });
  connect(&model_, &ProjectModel::opened, this, &MainWindow::showOpened);
  connect(&model_, &ProjectModel::failed, this, [this](const QString& what, const QString& why) {
    reading_->clear();
    say(what, why);
  });
  connect(&model_, &ProjectModel::stagesChanged, this, &MainWindow::showStages);
  connect(&model_, &ProjectModel::valuesChanged, this, &MainWindow::showValues);
  connect(&model_, &ProjectModel::settingsChanged, this, &MainWindow::showTitle);
  connect(&model_, &ProjectModel::frameChanged, this, [this] {
    splat_->setCapture(model_.capture(), model_.frame());
    showStatus();
  });
  connect(&lights_, &LightLibrary::lightChanged, this, [this] {
    splat_->setLight(lights_.light(), lights_.name());
    images_->setLight({lights_.light(), splat_->state().yaw_rad});
  });
  connect(&lights_, &LightLibrary::failed, this, &MainWindow::say);
}

void MainWindow::connectViews() {
  connect(views_, &QStackedWidget::currentChanged, this, [this] {
    // The light may have been turned since.
    if (views_->currentWidget() == images_) images_->setLight({lights_.light(), splat_->state().yaw_rad});
  });
  connect(splat_, &SplatView::hovered, reading_, &QLabel::setText);
  connect(splat_, &SplatView::pictureShown, this, &MainWindow::showStatus);
  connect(&images_->view(), &ImageView::hovered, reading_, &QLabel::setText);
  connect(splat_, &SplatView::stateChanged, this, [this](const ViewState& state) {
    project_panel_->mark(state.look_through);
    if (state.look_through) images_->choose(*state.look_through);
  });
  connect(project_panel_, &ProjectPanel::cameraActivated, this, [this](ViewIndex view) {
    images_->choose(view);
    splat_->lookThrough(view);
  });
}

void MainWindow::connectJob() {
  connect(run_bar_, &RunBar::runWanted, this, [this](const QString& until) { run(until.toStdString()); });
  connect(run_bar_, &RunBar::stopWanted, this, &MainWindow::cancelRun);
  connect(&job_, &JobBridge::stageStarted, this,
          [this](const StageStarted& stage) { rail_->setRunning(stage.stage, 0); });
  connect(&job_, &JobBridge::progressed, this, [this](const StepProgress& progress) {
    run_bar_->showProgress(progress);
    rail_->setRunning(stageOf(progress.ref.step), progress.report.fraction);
  });
  connect(&job_, &JobBridge::stepFinished, this, [this] { model_.refresh(true); });
  connect(&job_, &JobBridge::stepFailed, this, [this](const StepFailed& failure) {
    say("Frame " + QString::fromStdString(failure.ref.frame_name) + " failed at " +
            QString::fromStdString(failure.ref.step),
        QString::fromStdString(failure.message));
  });
  connect(&job_, &JobBridge::warned, this,
          [this](const QString& text) { log_->add(LogLevel::Warning, text); });
  connect(&job_, &JobBridge::previewChanged, this, [this](const std::shared_ptr<const GaussianCloud>& cloud) {
    previewing_ = true;
    splat_->setScene(
        {cloud, nullptr},
        QString("frame %1 · live preview, %L2 Gaussians").arg(model_.frameName()).arg(cloud->size()));
    if (views_->currentWidget() == scene_) scene_->setCloud(cloud);
  });
  connect(&job_, &JobBridge::finished, this, &MainWindow::showFinished);
  connect(&sample_, &SampleMaker::progressed, run_bar_, &RunBar::showReport);
  connect(&sample_, &SampleMaker::done, this, [this](const QString& folder) {
    run_bar_->showFinished("The sample is ready");
    open(folder.toStdString());
  });
  connect(&sample_, &SampleMaker::failed, this, [this](const QString& why) {
    run_bar_->showFinished(why.isEmpty() ? "Cancelled" : "The sample was not made");
    if (!why.isEmpty()) say("The sample was not made", why);
  });
}

void MainWindow::run(const std::string& until, bool all_frames) {
  if (!model_.isOpen() || job_.busy() || sample_.busy()) return;
  if (!model_.save()) return;
  message_->hide();
  RunRequest request;
  request.until = until;
  if (!all_frames) request.frames = {model_.frame()};
  job_.start(model_.project(), request, services_.job_device);
  run_bar_->showStarted(all_frames ? QString("Starting all frames") : "Starting frame " + model_.frameName());
}

void MainWindow::cancelRun() {
  run_bar_->showStopping();
  job_.requestStop();
  sample_.requestStop();
}

void MainWindow::showOpened() {
  message_->hide();
  reading_->clear();
  previewing_ = false;
  remember(QString::fromStdString(model_.project().folder().string()));
  centre_->setCurrentIndex(1);
  run_bar_->setReady(!model_.project().readOnly() || !Project::isProject(model_.project().folder()));
  run_bar_->showFinished({});
  splat_->setScene({}, {});
  splat_->setCapture(model_.capture(), model_.frame());
  scene_->setCapture(model_.capture());
  scene_->setCloud(nullptr);
  scene_->setMesh(nullptr);
  images_->refresh();
  log_->add(LogLevel::Info, "Opened " + QString::fromStdString(model_.project().folder().string()));
  for (const std::string& warning : model_.project().imported().warnings)
    log_->add(LogLevel::Warning, QString::fromStdString(warning));
  try {
    lights_.reset(model_.project().environmentFile().value_or(std::filesystem::path()));
  } catch (const Error& e) {
    lights_.reset({});
    say("The panorama is gone", QString::fromStdString(e.what()));
  }
  showTitle();
  showStatus();
}

void MainWindow::showValues() {
  const FrameValues& values = model_.values();
  // A finished step between two previews would throw the view back to an older picture.
  if (!(previewing_ && job_.busy()) || values.materials) {
    splat_->setScene({values.cloud, values.materials}, "frame " + model_.frameName());
  }
  scene_->setCloud(values.cloud);
  scene_->setMesh(values.mesh);
  images_->refresh();
  showStatus();
}

void MainWindow::showStages() {
  rail_->setStages(model_.stages());
  images_->refresh();
}

void MainWindow::showFinished(const JobFinished& outcome) {
  previewing_ = false;
  rail_->setRunning({}, 0);
  const QString took = durationText(outcome.seconds);
  const QString steps =
      QString("%1 steps computed, %2 were there already").arg(outcome.computed).arg(outcome.reused);
  switch (outcome.outcome) {
    case JobOutcome::Done:
      run_bar_->showFinished(QString("Done in %1: %2").arg(took, steps));
      break;
    case JobOutcome::DoneWithFailures:
      run_bar_->showFinished(
          QString("Done in %1, %2 frames failed: %3").arg(took).arg(outcome.failed.size()).arg(steps));
      break;
    case JobOutcome::Cancelled:
      run_bar_->showFinished("Cancelled after " + took + "; finished steps are kept, Run goes on from there");
      break;
    case JobOutcome::Failed:
      run_bar_->showFinished("The run stopped after " + took);
      say("The run stopped", QString::fromStdString(outcome.message));
      break;
  }
  log_->add(LogLevel::Info, run_bar_->text());
  QStringList notes;
  for (const std::string& note : outcome.notes) notes << QString::fromStdString(note);
  if (!notes.isEmpty()) message_->show(MessagePanel::Kind::Notice, "Left out", notes.join("\n"));
  model_.refresh();
  project_panel_->refreshScores();
}

void MainWindow::showTitle() {
  if (!model_.isOpen()) return setWindowTitle("BEAM Studio");
  setWindowTitle(
      QString("%1%2 · BEAM Studio")
          .arg(QString::fromStdString(model_.project().name()), model_.unsaved() ? " (not saved)" : ""));
}

void MainWindow::showStatus() {
  QStringList parts;
  if (model_.isOpen()) parts << "frame " + model_.frameName();
  if (model_.values().cloud) {
    parts << QString("drawn in %1 ms").arg(splat_->fullPictureMilliseconds(), 0, 'f', 0);
  }
  parts << QString::fromStdString(services_.view_device->info().title);
  state_words_->setText(parts.join("   ·   "));
}

}  // namespace beam
