// SPDX-License-Identifier: Apache-2.0
// One long piece of work that is no run of the pipeline, on a thread of its own: a sample being made, a
// project being copied. Progress and cancel like those of a run.
#pragma once

#include <QObject>
#include <QTimer>

#include <functional>
#include <thread>

#include "core/base/progress.h"
#include "core/base/slot.h"

namespace beam {

class BackgroundTask final : public QObject {
  Q_OBJECT

 public:
  // On the task's thread; may throw. To be cancelled is to throw Cancelled.
  using Work = std::function<void(Progress&)>;

  explicit BackgroundTask(QObject* parent = nullptr);
  ~BackgroundTask() override;

  // One at a time: throws Error{Bug} while one is going on. `then` is called on the window's thread when the
  // work is done whole.
  void start(Work work, std::function<void()> then);
  void requestStop() { thread_.request_stop(); }
  bool busy() const { return busy_; }

 Q_SIGNALS:
  void progressed(const beam::ProgressReport& report);
  void done();
  void failed(const QString& why);  // empty: cancelled

 private:
  void finish(const QString& error, bool complete);

  bool busy_ = false;
  std::function<void()> then_;
  std::shared_ptr<Slot<ProgressReport>> report_;
  QTimer timer_;
  std::jthread thread_;  // last: it stops first
};

}  // namespace beam
