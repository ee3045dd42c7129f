// SPDX-License-Identifier: Apache-2.0
// Runs as the window starts and shows them; and what of a run's preview is in view.
#include <algorithm>

#include "core/base/duration_text.h"
#include "ui/log_panel.h"
#include "ui/main_window.h"
#include "ui/message_panel.h"
#include "ui/project_panel.h"
#include "ui/run_bar.h"
#include "ui/settings_panel.h"
#include "ui/stage_rail.h"
#include "ui/timeline_panel.h"
#include "ui/words.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {

namespace {

RunOverlay overlayOf(const RunRequest& request, int frames_of_take) {
  RunOverlay run;
  run.until = request.until;
  run.active = true;
  const int first = request.frames.empty() ? 0 : request.frames.front().value;
  const int last = request.frames.empty() ? frames_of_take - 1 : request.frames.back().value;
  for (int f = first; f <= last; f += request.every) run.frames.push_back(f);
  return run;
}

}  // namespace

RunRequest MainWindow::requestOf(const std::string& until, RunScope scope, int every) const {
  RunRequest request;
  request.until = until;
  if (scope == RunScope::Scout) request.every = std::max(every, 1);
  const FrameRange range =
      scope == RunScope::Frame ? FrameRange{model_.frame().value, model_.frame().value} : player_.range();
  // A whole take goes on with the takes that are there; named frames may become one of their own.
  if (scope == RunScope::Take) return request;
  request.keeps_takes = true;
  for (int f = range.first; f <= range.last; ++f) request.frames.push_back(FrameIndex{f});
  return request;
}

void MainWindow::run(const std::string& until, RunScope scope, int every) {
  if (const QString why = refusalToRun(); !why.isEmpty()) return say("The run cannot start", why);
  if (!takeOverSettings("The run did not start") || !model_.save()) return;
  message_->hide();
  preview_ = {};
  showSplats();
  RunRequest request = requestOf(until, scope, every);
  request.times = forecast_.machineTimes();
  run_ = overlayOf(request, model_.frameCount());
  timeline_->setRun(run_);
  model_.startRun();
  job_.start(model_.project(), request, services_.job_device);
  settings_->setRunning(true);
  run_bar_->showStarted(run_.frames.size() == 1
                            ? "Starting frame " + model_.nameOf(FrameIndex{run_.frames.front()})
                            : "Starting " +
                                  countText(static_cast<std::int64_t>(run_.frames.size()), "frame"));
  refreshCommands();
}

void MainWindow::scout() {
  if (!takeOverSettings("Nothing was scouted")) return;
  if (const QString why = commands_.refusalOf("scout"); !why.isEmpty()) return say("Nothing to scout", why);
  const ScoutPlan plan{player_.range().size(), model_.survey() ? secondsAFrame(*model_.survey()) : 0,
                       QString::fromStdString(model_.project().document().preset)};
  const std::optional<int> every = askScout(this, plan, scout_every_);
  if (!every) return;
  scout_every_ = *every;
  run({}, RunScope::Scout, scout_every_);
}

void MainWindow::cancelRun() {
  if (!refusalToStop().isEmpty()) return;
  stopping_ = true;
  run_bar_->showStopping();
  job_.requestStop();
  task_.requestStop();
  refreshCommands();
}

void MainWindow::stopAfter(StopAfter what) {
  job_.requestStopAfter(what);
  run_bar_->showStopping(what == StopAfter::Step ? "after this step" : "after this frame");
}

// Of the commands that run, before they are pressed.
void MainWindow::askForecast() {
  if (player_.playing()) return;  // frames pass by; it reads every record of the project
  if (!model_.isOpen() || model_.captureLost() || job_.busy()) return forecast_.forget();
  std::vector<RunRequest> requests;
  for (const RunScope scope : {RunScope::Frame, RunScope::Range, RunScope::Take})
    requests.push_back(requestOf({}, scope, 1));
  forecast_.ask(model_.project(), std::move(requests));
}

// Of the run that Run starts.
void MainWindow::showForecast() {
  const std::vector<RunEstimate>& estimates = forecast_.estimates();
  const char* const commands[] = {"run_frame", "run_range", "run_take"};
  for (std::size_t i = 0; i < 3; ++i)
    commands_.setNote(commands[i], i < estimates.size() ? forecastText(estimates[i]) : QString());
  run_bar_->setPlan(estimates.empty() ? QString() : forecastText(estimates.front()));
}

void MainWindow::showRunning(const std::string& stage, std::optional<FrameIndex> frame) {
  rail_->setRunning(stage, 0);
  const int f = frame ? frame->value : -1;
  if (run_.running_stage == stage && run_.running_frame == f) return;
  run_.running_stage = stage;
  run_.running_frame = f;
  timeline_->setRun(run_);
}

void MainWindow::takePreview(const JobPreview& preview) {
  preview_ = {preview.cloud, preview.ref.frame ? preview.ref.frame->value : -1, true};
  if (previewWins()) showSplats();
  if (previewWins() && shownView() == StudioView::Scene) scene_->setCloud(preview.cloud);
}

// Only where its frame is looked at: other frames may be watched while this one is solved. A finished step
// between two previews would throw the view back to an older picture, so that only new materials take its
// place.
bool MainWindow::previewWins() const {
  if (!preview_.cloud || player_.playing() || preview_.frame != model_.frame().value) return false;
  return !(model_.valuesReady() && model_.values().materials && !model_.values().stale);
}

void MainWindow::showFinished(const JobFinished& outcome) {
  stopping_ = false;
  const bool kept = outcome.outcome == JobOutcome::Cancelled || outcome.outcome == JobOutcome::Failed;
  if (kept) {
    preview_.live = false;
  } else {
    preview_ = {};
  }
  run_ = {};
  timeline_->setRun(run_);
  rail_->setRunning({}, 0);
  const QString took = QString::fromStdString(durationText(outcome.seconds));
  const QString steps = QString("%1 computed, %2 there already")
                            .arg(countText(outcome.computed, "step"), numberText(outcome.reused));
  switch (outcome.outcome) {
    case JobOutcome::Done:
      run_bar_->showFinished(QString("Done in %1: %2").arg(took, steps));
      break;
    case JobOutcome::DoneWithFailures:
      run_bar_->showFinished(
          QString("Done in %1, %2 failed: %3")
              .arg(took, countText(static_cast<std::int64_t>(outcome.failed.size()), "frame"), steps));
      break;
    case JobOutcome::Cancelled:
      if (outcome.at_rest && !outcome.notes.empty()) {
        run_bar_->showFinished(QString::fromStdString(outcome.notes.back()));
        break;
      }
      run_bar_->showFinished("Cancelled after " + took + "; finished steps are kept, Run goes on from there");
      break;
    case JobOutcome::Failed:
      run_bar_->showFinished("The run stopped after " + took);
      say("The run stopped", QString::fromStdString(outcome.message));
      break;
  }
  log_->add(LogLevel::Info, run_bar_->text());
  QStringList notes;
  for (const std::string& note : outcome.notes)
    notes << withStepTitles(services_.pipeline->stages.infos(), QString::fromStdString(note));
  if (!notes.isEmpty() && !outcome.at_rest)
    message_->show(MessagePanel::Kind::Notice, "Left out", notes.join("\n"));
  settings_->setRunning(false);
  const bool lost = !model_.project().captureIsThere();
  if (lost) model_.setCaptureThere(false);
  model_.endRun();
  showSplats();
  project_panel_->refreshScores();
  refreshCommands();
  if (lost) showCaptureLost();  // last: what failed for the want of it speaks of pictures
}

}  // namespace beam
