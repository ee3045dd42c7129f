// SPDX-License-Identifier: Apache-2.0
#include "ui/background_task.h"

#include "core/base/error.h"

namespace beam {
namespace {

constexpr int kTell_ms = 100;

}  // namespace

BackgroundTask::BackgroundTask(QObject* parent) : QObject(parent) {
  timer_.setInterval(kTell_ms);
  connect(&timer_, &QTimer::timeout, this, [this] {
    if (const auto report = task_->progress()) Q_EMIT progressed(*report);
  });
}

BackgroundTask::~BackgroundTask() = default;

void BackgroundTask::begin(Task<Continuation>::Work work) {
  if (busy_) throw Error(Error::Kind::Bug, "a background task was started while another one went on");
  busy_ = true;
  timer_.start();
  task_.emplace(std::move(work),
                [this] { QMetaObject::invokeMethod(this, &BackgroundTask::finish, Qt::QueuedConnection); });
}

void BackgroundTask::finish() {
  busy_ = false;
  timer_.stop();
  Continuation then;
  try {
    then = task_->take();
  } catch (const Cancelled&) {
    Q_EMIT failed({});
    return;
  } catch (const std::exception& e) {  // the border of the task's thread: said in the window
    Q_EMIT failed(QString::fromStdString(e.what()));
    return;
  }
  Q_EMIT done();
  then();
}

}  // namespace beam
