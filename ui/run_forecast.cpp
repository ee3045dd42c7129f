// SPDX-License-Identifier: Apache-2.0
#include "ui/run_forecast.h"

#include "core/base/log.h"
#include "ui/remaining_time.h"
#include "ui/words.h"

namespace beam {

QString forecastText(const RunEstimate& e) {
  if (e.steps_missing == 0) return countText(e.frames_total, "frame") + ": everything is there already";
  QString missing =
      QString("%1: %2 missing").arg(countText(e.frames, "frame"), countText(e.steps_missing, "step"));
  if (e.leaves_take) missing += ", fitted apart from its take";
  if (!e.measured) return missing + "; how long they take is known after the first";
  return missing + ", " + rangeText(e.seconds_low, e.seconds_high);
}

RunForecast::RunForecast(QObject* parent) : QObject(parent) {}

StepTimes RunForecast::allTimes() const {
  StepTimes all = machine_;
  all.add(own_);
  return all;
}

void RunForecast::forget() {
  seen_ = ++ticket_;
  if (estimates_.empty()) return;
  estimates_.clear();
  Q_EMIT told();
}

void RunForecast::ask(const Project& project, std::vector<RunRequest> requests) {
  const std::uint64_t ticket = ++ticket_;
  worker_.submit([this, project, requests = std::move(requests), machine = machine_, ticket] {
    std::vector<RunEstimate> estimates;
    StepTimes own;
    try {
      own = readStepTimes(project);
      StepTimes times = machine;
      times.add(own);
      for (const RunRequest& request : requests) estimates.push_back(estimateRun(project, request, times));
    } catch (const std::exception& e) {  // the border of this thread; the run itself will say it
      logDebug("no forecast: {}", e.what());
      estimates.clear();
    }
    QMetaObject::invokeMethod(
        this,
        [this, estimates, own, ticket] {
          if (ticket != ticket_) return;
          seen_ = ticket;
          estimates_ = estimates;
          own_ = own;
          Q_EMIT told();
        },
        Qt::QueuedConnection);
  });
}

}  // namespace beam
