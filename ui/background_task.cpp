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
    if (const auto report = report_->latest()) Q_EMIT progressed(*report);
  });
}

BackgroundTask::~BackgroundTask() = default;

void BackgroundTask::start(Work work, std::function<void()> then) {
  if (busy_) throw Error(Error::Kind::Bug, "a background task was started while another one went on");
  busy_ = true;
  then_ = std::move(then);
  report_ = std::make_shared<Slot<ProgressReport>>();
  timer_.start();
  thread_ = std::jthread([this, work = std::move(work), report = report_](const std::stop_token& stop) {
    QString error;
    bool complete = false;
    try {
      Progress progress(
          stop, [report](const ProgressReport& r) { report->publish(std::make_shared<ProgressReport>(r)); });
      work(progress);
      complete = true;
    } catch (const Cancelled&) {
    } catch (const std::exception& e) {  // the border of this thread: said in the window
      error = QString::fromStdString(e.what());
    }
    QMetaObject::invokeMethod(
        this, [this, error, complete] { finish(error, complete); }, Qt::QueuedConnection);
  });
}

void BackgroundTask::finish(const QString& error, bool complete) {
  busy_ = false;
  timer_.stop();
  const std::function<void()> then = std::exchange(then_, nullptr);
  if (!complete) {
    Q_EMIT failed(error);
    return;
  }
  Q_EMIT done();
  if (then) then();
}

}  // namespace beam
