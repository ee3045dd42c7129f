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
  // Commands of the window. The first of `runs` is what Run does, the others and `until` are behind its
  // arrow; `stop` is what Cancel does, `later` is behind its.
  void bind(const std::vector<QAction*>& runs, const std::vector<QAction*>& until, QAction* stop,
            const std::vector<QAction*>& later);
  // What Run would do and about how long it takes; empty: not known.
  void setPlan(const QString& plan);
  void showStarted(const QString& what);
  void showProgress(const StepProgress& progress);
  // Of a job that is not a run: a sample being made. What was said at its start goes before.
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
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 private:
  int widthFor(int letters) const;  // of the words
  void setRunning(bool running);
  void showParts();
  void say(const QString& words);

  QToolButton *run_, *stop_;
  QProgressBar* bar_;
  ElidedLabel *plan_, *words_;
  std::vector<StageInfo> stages_;
  RemainingTime remaining_;
  QElapsedTimer clock_;
  QString stopping_, what_;  // `what_`: was started
  bool running_ = false;
};

}  // namespace beam
