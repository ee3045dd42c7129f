// SPDX-License-Identifier: Apache-2.0
// Run, run until a stage, cancel; and the five facts of a long action: what, where, done, left, can I stop.
// Before a run: what it would take. The buttons are always whole, the words give way.
#pragma once

#include <QElapsedTimer>
#include <QWidget>

#include "core/pipeline/job_event.h"
#include "core/pipeline/stage_registry.h"
#include "ui/remaining_time.h"
#include "ui/words.h"

class QAction;
class QProgressBar;
class QToolButton;

namespace beam {

class ElidedLabel;

class RunBar final : public QWidget {
  Q_OBJECT

 public:
  explicit RunBar(QWidget* parent = nullptr);

  void setStages(const std::vector<StageInfo>& stages);
  // Why nothing can be run, as a sentence; empty: it can.
  void setRefusal(const QString& why);
  // What Run would do and about how long it takes; empty: not known.
  void setPlan(const QString& plan);
  void showStarted(const QString& what);
  void showProgress(const StepProgress& progress);
  // `done` of a job that is not a run: a sample being made.
  void showReport(const ProgressReport& report);
  // The run waits for work of another process: "waits for frame 000000, which process 1234 computes".
  void showWaiting(const QString& text);
  // `how`: "after this step"; empty: now, and there is nothing left to stop.
  void showStopping(const QString& how = {});
  void showFinished(const QString& outcome);
  bool running() const { return running_; }
  // What is said now: of the run, of the last one, or the plan of the next.
  QString text() const;
  const RemainingTime& remaining() const { return remaining_; }
  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  void runWanted(const QString& until);  // of the shown frame; empty: everything
  void rangeWanted();                    // everything from the in to the out point
  void scoutWanted();                    // every Kth frame from the in to the out point
  void takeWanted();                     // everything of the whole take
  void stopWanted();                     // now
  void stopAfterStepWanted();
  void stopAfterFrameWanted();

 private:
  void makeStop();
  void setRunning(bool running);
  void showButtons();
  void say(const QString& words);

  QToolButton *run_, *stop_;
  QAction *after_step_ = nullptr, *after_frame_ = nullptr;
  QProgressBar* bar_;
  ElidedLabel *plan_, *words_;
  std::vector<StageInfo> stages_;
  RemainingTime remaining_;
  QElapsedTimer clock_;
  QString refusal_, stopping_;
  bool running_ = false, can_stop_ = false;
};

}  // namespace beam
