// SPDX-License-Identifier: Apache-2.0
// Who hears whom: model to panels and views, views to panels, job to everything.
#include <QLabel>
#include <QStackedWidget>

#include <algorithm>

#include "ui/image_page.h"
#include "ui/log_panel.h"
#include "ui/main_window.h"
#include "ui/message_panel.h"
#include "ui/project_panel.h"
#include "ui/run_bar.h"
#include "ui/settings_panel.h"
#include "ui/stage_rail.h"
#include "ui/timeline_panel.h"
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
    splat_->setLight(lights_.light(), lights_.name(), lights_.reading());
    images_->setLight({lights_.light(), splat_->state().yaw_rad, lights_.reading()});
  });
  connect(&lights_, &LightLibrary::failed, this, &MainWindow::say);
}

void MainWindow::connectViews() {
  connect(views_, &QStackedWidget::currentChanged, this, [this] {
    // The light may have been turned since; and a view that is not seen does not follow the frames.
    if (views_->currentWidget() == images_)
      images_->setLight({lights_.light(), splat_->state().yaw_rad, lights_.reading()});
    showValuesIn(shownView());
  });
  connect(scene_, &SceneView::jointPicked, &joints_, &JointSource::pick);
  connect(&joints_, &JointSource::changed, this, [this] {
    const JointsShown& shown = joints_.shown();
    scene_->setJoints(shown.trails, shown.hint);
    scene_->setInfluence(shown.influence ? joints_.picked() : -1, shown.influence);
  });
  connect(scene_, &SceneView::cameraPicked, this, [this](ViewIndex view) {
    project_panel_->mark(view);
    images_->choose(view);
  });
  connect(scene_, &SceneView::cameraActivated, splat_, &SplatView::lookThrough);
  connect(splat_, &SplatView::hovered, reading_, &QLabel::setText);
  connect(splat_, &SplatView::pictureShown, this, &MainWindow::showStatus);
  connect(&images_->view(), &ImageView::hovered, reading_, &QLabel::setText);
  connect(splat_, &SplatView::stateChanged, this, [this](const ViewState& state) {
    project_panel_->mark(state.look_through);
    if (!state.look_through) return;
    images_->choose(*state.look_through);
    scene_->markCamera(state.look_through);
  });
  connect(project_panel_, &ProjectPanel::cameraActivated, this, [this](ViewIndex view) {
    images_->choose(view);
    splat_->lookThrough(view);
    scene_->lookThrough(view);
  });
}

void MainWindow::connectJob() {
  connect(run_bar_, &RunBar::runWanted, this, [this](const QString& until) { run(until.toStdString()); });
  connect(run_bar_, &RunBar::rangeWanted, this, [this] { run({}, RunScope::Range); });
  connect(run_bar_, &RunBar::scoutWanted, this, &MainWindow::scout);
  connect(run_bar_, &RunBar::takeWanted, this, [this] { run({}, RunScope::Take); });
  connect(run_bar_, &RunBar::stopWanted, this, &MainWindow::cancelRun);
  connect(&job_, &JobBridge::stageStarted, this,
          [this](const StageStarted& stage) { showRunning(stage.stage, stage.frame); });
  connect(&job_, &JobBridge::progressed, this, [this](const StepProgress& progress) {
    run_bar_->showProgress(progress);
    showRunning(stageOf(progress.ref.step), progress.ref.frame);
    rail_->setRunning(stageOf(progress.ref.step), progress.report.fraction);
  });
  connect(&job_, &JobBridge::stepFinished, this, [this] { model_.refresh(); });
  connect(&job_, &JobBridge::stepFailed, this, [this](const StepFailed& failure) {
    say("Frame " + QString::fromStdString(failure.ref.frame_name) + " failed at " +
            QString::fromStdString(failure.ref.step),
        QString::fromStdString(failure.message));
  });
  connect(&job_, &JobBridge::warned, this,
          [this](const QString& text) { log_->add(LogLevel::Warning, text); });
  connect(&job_, &JobBridge::previewChanged, this, [this](const std::shared_ptr<const GaussianCloud>& cloud) {
    // Only where its frame is looked at: other frames may be watched while this one is solved.
    previewing_ = run_.running_frame == model_.frame().value && !player_.playing();
    if (!previewing_) return;
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

void MainWindow::connectPlayer() {
  connect(&player_, &Player::playingChanged, this, &MainWindow::showPlaying);
  connect(splat_, &SplatView::pictureShown, &player_, &Player::poll);
}

void MainWindow::run(const std::string& until, RunScope scope, int every) {
  if (!model_.isOpen() || job_.busy() || sample_.busy()) return;
  if (const auto why = settings_->takeOver()) return say("The run did not start", *why);
  if (!model_.save()) return;
  message_->hide();
  RunRequest request;
  request.until = until;
  if (scope == RunScope::Scout) request.every = std::max(every, 1);
  const FrameRange all{0, static_cast<int>(model_.capture()->frames.size()) - 1};
  const FrameRange range = scope == RunScope::Take ? all
                           : scope != RunScope::Frame
                               ? player_.range()
                               : FrameRange{model_.frame().value, model_.frame().value};
  run_ = {};
  run_.until = until;
  run_.active = true;
  for (int f = range.first; f <= range.last; ++f) {
    if ((f - range.first) % request.every == 0) run_.frames.push_back(f);
    // A whole take goes on with the takes that are there; named frames would become one of their own.
    if (scope != RunScope::Take) request.frames.push_back(FrameIndex{f});
  }
  timeline_->setRun(run_);
  job_.start(model_.project(), request, services_.job_device);
  settings_->setRunning(true);
  run_bar_->showStarted(range.size() == 1 ? "Starting frame " +
                                                QString::fromStdString(model_.capture()->frames[range.first])
                                          : QString("Starting %1 frames").arg(run_.frames.size()));
}

void MainWindow::scout() {
  if (!model_.isOpen() || job_.busy() || sample_.busy()) return;
  const ScoutPlan plan{player_.range().size(), model_.survey() ? secondsAFrame(*model_.survey()) : 0,
                       QString::fromStdString(model_.project().document().preset)};
  if (plan.frames < 3) return say("Nothing to scout", "A scout run needs an in–out range of three frames.");
  const std::optional<int> every = askScout(this, plan, scout_every_);
  if (!every) return;
  scout_every_ = *every;
  run({}, RunScope::Scout, scout_every_);
}

void MainWindow::showRunning(const std::string& stage, std::optional<FrameIndex> frame) {
  rail_->setRunning(stage, 0);
  const int f = frame ? frame->value : -1;
  if (run_.running_stage == stage && run_.running_frame == f) return;
  run_.running_stage = stage;
  run_.running_frame = f;
  timeline_->setRun(run_);
}

void MainWindow::showPlaying() {
  if (!player_.playing()) {
    splat_->setPassing(0);
    timeline_->setPictureNote({});
    showStages();
    return showValues();
  }
  previewing_ = false;
  const double interval_ms = 1000 / player_.clock().takeRate();
  const int divisor = full_size_play_ ? 1
                                      : playDivisor(splat_->fullPictureMilliseconds(),
                                                    splat_->halfPictureMilliseconds(), interval_ms);
  splat_->setPassing(divisor);
  timeline_->setPictureNote(shownView() != StudioView::Splat || divisor == 1 ? QString()
                            : divisor == 2                                   ? "half size"
                                                                             : "quarter size");
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
  const bool can_run = !model_.project().readOnly() || !Project::isProject(model_.project().folder());
  run_bar_->setRefusal(can_run ? QString() : QString("The project is read-only: look, do not run"));
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
    case StudioView::Splat: {
      // A finished step between two previews would throw the view back to an older picture.
      if (previewing_ && job_.busy() && run_.running_frame == model_.frame().value && !values.materials)
        return;
      if (const auto& held = model_.held()) {
        const QString from = QString::fromStdString(model_.capture()->frames[held->from.value]);
        return splat_->setScene(
            {held->values.cloud, held->values.materials},
            QString("frame %1 is not solved: held from %2").arg(model_.frameName(), from));
      }
      return splat_->setScene({values.cloud, values.materials},
                              "frame " + model_.frameName() + (values.interpolated ? ", interpolated" : ""));
    }
    case StudioView::Image:
      return images_->refresh();
    case StudioView::Scene:
      scene_->setCloud(values.cloud);
      scene_->setMesh(values.mesh);
      if (shownView() == StudioView::Scene) joints_.refresh();
  }
}

void MainWindow::showStages() {
  if (player_.playing()) return;  // the rail tells of one frame: of the one that is looked at at rest
  rail_->setStages(model_.stages());
  images_->refresh();
  if (shownView() == StudioView::Scene) joints_.refresh();
}

void MainWindow::showFinished(const JobFinished& outcome) {
  previewing_ = false;
  run_ = {};
  timeline_->setRun(run_);
  settings_->setRunning(false);
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
  model_.refresh(true);
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
  if (model_.isOpen())
    parts << "frame " + model_.frameName() + (model_.values().interpolated ? ", interpolated" : "");
  if (model_.values().cloud) {
    parts << QString("drawn in %1 ms").arg(splat_->fullPictureMilliseconds(), 0, 'f', 0);
  }
  parts << QString::fromStdString(services_.view_device->info().title);
  state_words_->setText(parts.join("   ·   "));
}

}  // namespace beam
