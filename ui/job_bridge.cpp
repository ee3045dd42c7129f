// SPDX-License-Identifier: Apache-2.0
#include "ui/job_bridge.h"

namespace beam {
namespace {

constexpr int kDrain_ms = 33;

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

}  // namespace

JobBridge::JobBridge(QObject* parent) : QObject(parent) {
  timer_.setInterval(kDrain_ms);
  connect(&timer_, &QTimer::timeout, this, &JobBridge::drain);
}

void JobBridge::start(const Project& project, const RunRequest& request,
                      std::shared_ptr<ComputeDevice> device) {
  shown_ = runner_.preview().latest();  // of the run before; a quick one shows its first at once
  runner_.start(project, request, std::move(device));
  busy_ = true;
  timer_.start();
}

void JobBridge::requestStop() { runner_.requestStop(); }

void JobBridge::requestStopAfter(StopAfter what) { runner_.requestStopAfter(what); }

void JobBridge::drain() {
  if (auto preview = runner_.preview().latest(); preview && preview != shown_) {
    shown_ = std::move(preview);
    Q_EMIT previewChanged(*shown_);
  }
  while (std::optional<JobEvent> event = runner_.tryPop()) tell(*event);
}

void JobBridge::tell(const JobEvent& event) {
  std::visit(Overloaded{
                 [this](const StageStarted& e) { Q_EMIT stageStarted(e); },
                 [this](const StepProgress& e) { Q_EMIT progressed(e); },
                 [this](const StepFinished& e) { Q_EMIT stepFinished(e); },
                 [this](const StepFailed& e) { Q_EMIT stepFailed(e); },
                 [this](const JobWarning& e) { Q_EMIT warned(QString::fromStdString(e.text)); },
                 [this](const JobWaiting& e) { Q_EMIT waiting(e); },
                 [this](const JobFinished& e) {
                   busy_ = false;
                   timer_.stop();
                   Q_EMIT finished(e);
                 },
             },
             event);
}

}  // namespace beam
