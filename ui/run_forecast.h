// SPDX-License-Identifier: Apache-2.0
// What a run would do before it is started: how many frames, how many steps, about how long on this machine.
// Worked out on a background thread; times are those that results of the project took, else those of other
// projects here.
#pragma once

#include <QObject>
#include <QString>

#include <vector>

#include "core/pipeline/run_estimate.h"
#include "core/pipeline/step_times.h"
#include "viewers/latest_worker.h"

namespace beam {

// "1 frame: 5 steps missing, 2 to 3 min", "2 frames: everything is there already", "30 frames: 150 steps
// missing; how long they take is known after the first".
QString forecastText(const RunEstimate& estimate);

class RunForecast final : public QObject {
  Q_OBJECT

 public:
  explicit RunForecast(QObject* parent = nullptr);

  // Answers with told(), in the order of the requests; a newer question replaces one that is not answered
  // yet.
  void ask(const Project& project, std::vector<RunRequest> requests);
  void forget();                                                            // no answer to what was asked
  const std::vector<RunEstimate>& estimates() const { return estimates_; }  // empty: not known
  bool settled() const { return seen_ == ticket_; }
  // What this machine measured in projects before.
  void setMachineTimes(const StepTimes& times) { machine_ = times; }
  const StepTimes& machineTimes() const { return machine_; }
  // With those of the project that was asked about last.
  StepTimes allTimes() const;

 Q_SIGNALS:
  void told();

 private:
  std::vector<RunEstimate> estimates_;
  StepTimes machine_, own_;
  std::uint64_t ticket_ = 0, seen_ = 0;
  LatestWorker worker_;  // last: it stops first
};

}  // namespace beam
