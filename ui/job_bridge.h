// SPDX-License-Identifier: Apache-2.0
// The one door between the job's thread and the window's: drains events and the newest preview 30 times a
// second.
#pragma once

#include <QObject>
#include <QTimer>

#include "core/pipeline/runner.h"

namespace beam {

class JobBridge final : public QObject {
  Q_OBJECT

 public:
  explicit JobBridge(QObject* parent = nullptr);

  // Throws Error{Bug} while a job runs.
  void start(const Project& project, const RunRequest& request, std::shared_ptr<ComputeDevice> device);
  void requestStop();
  void requestStopAfter(StopAfter what);
  // From start until finished() was emitted.
  bool busy() const { return busy_; }

 Q_SIGNALS:
  void stageStarted(const beam::StageStarted& stage);
  void progressed(const beam::StepProgress& progress);
  void stepFinished(const beam::StepFinished& step);
  void stepFailed(const beam::StepFailed& failure);
  void warned(const QString& text);
  void waiting(const beam::JobWaiting& waiting);
  void previewChanged(const beam::JobPreview& preview);
  void finished(const beam::JobFinished& outcome);

 private:
  void drain();
  void tell(const JobEvent& event);

  Runner runner_;
  QTimer timer_;
  bool busy_ = false;
  std::shared_ptr<const JobPreview> shown_;
};

}  // namespace beam
