// SPDX-License-Identifier: Apache-2.0
// Run, run until a stage, cancel; and the five facts of a long action: what, where, done, left, can I stop.
#pragma once

#include <QElapsedTimer>
#include <QWidget>

#include "core/pipeline/job_event.h"
#include "core/pipeline/stage_registry.h"

class QLabel;
class QProgressBar;
class QPushButton;
class QToolButton;

namespace beam {

class RunBar final : public QWidget {
  Q_OBJECT

 public:
  explicit RunBar(QWidget* parent = nullptr);

  void setStages(const std::vector<StageInfo>& stages);
  void setReady(bool project_open);
  void showStarted(const QString& what);
  void showProgress(const StepProgress& progress);
  // `done` of a job that is not a run: a sample being made.
  void showReport(const ProgressReport& report);
  void showStopping();
  void showFinished(const QString& outcome);
  bool running() const { return running_; }
  QString text() const;

 Q_SIGNALS:
  void runWanted(const QString& until);  // of the shown frame; empty: everything
  void rangeWanted();                    // everything from the in to the out point
  void scoutWanted();                    // every Kth frame from the in to the out point
  void takeWanted();                     // everything of the whole take
  void stopWanted();

 private:
  void setRunning(bool running);

  QToolButton* run_;
  QPushButton* stop_;
  QProgressBar* bar_;
  QLabel* words_;
  bool ready_ = false, running_ = false;
};

// "4 min 10 s", "35 s", "1 h 05 min".
QString durationText(double seconds);

}  // namespace beam
