// SPDX-License-Identifier: Apache-2.0
#include "ui/capture_watch.h"

#include <utility>

namespace beam {
namespace {

constexpr int kLook_ms = 2000;

}  // namespace

CaptureWatch::CaptureWatch(QObject* parent) : QObject(parent) {
  timer_.setInterval(kLook_ms);
  connect(&timer_, &QTimer::timeout, this, &CaptureWatch::look);
  connect(&check_, &BackgroundTask::done, this, &CaptureWatch::checkWhenFree);
  connect(&check_, &BackgroundTask::failed, this, &CaptureWatch::checkWhenFree);
}

void CaptureWatch::start(const Project& project, const CaptureCheck& check) {
  stop();
  project_ = project;
  there_ = !project.withoutCapture();
  timer_.start();
  if (there_) due_ = check;
  checkWhenFree();
}

void CaptureWatch::checkWhenFree() {
  if (!due_ || check_.busy()) return;
  const std::uint64_t ticket = ticket_;
  check_.start(
      [check = std::exchange(due_, nullptr), project = *project_](Progress& progress) {
        ImportOptions options;
        options.up = project.document().up;
        options.hold_out = project.document().hold_out;
        options.placement = project.imported().placement;
        QStringList found;
        for (const std::string& warning : check(project.captureFolder(), options, progress))
          found.append(QString::fromStdString(warning));
        found.removeDuplicates();
        return found;
      },
      [this, ticket](const QStringList& found) {
        if (ticket == ticket_) Q_EMIT checked(found);
      });
}

void CaptureWatch::stop() {
  ++ticket_;
  timer_.stop();
  due_ = nullptr;
  check_.requestStop();
  project_.reset();
  there_ = true;
}

void CaptureWatch::look() {
  worker_.submit([this, project = *project_, ticket = ticket_] {
    const bool there = project.captureIsThere();
    QMetaObject::invokeMethod(
        this,
        [this, there, ticket] {
          if (ticket != ticket_ || there == there_) return;
          there_ = there;
          there ? Q_EMIT back() : Q_EMIT lost();
        },
        Qt::QueuedConnection);
  });
}

}  // namespace beam
