// SPDX-License-Identifier: Apache-2.0
// Makes the sample capture on a background thread, once; later it is only opened.
#pragma once

#include <QObject>
#include <QTimer>

#include <thread>

#include "core/base/slot.h"
#include "ui/studio_services.h"

namespace beam {

class SampleMaker final : public QObject {
  Q_OBJECT

 public:
  explicit SampleMaker(QObject* parent = nullptr);
  ~SampleMaker() override;

  // Answers with done() at once when the sample is there already.
  void start(const StudioServices& services);
  void requestStop() { thread_.request_stop(); }
  bool busy() const { return busy_; }

 Q_SIGNALS:
  void progressed(const beam::ProgressReport& report);
  void done(const QString& folder);
  void failed(const QString& why);  // empty: cancelled

 private:
  void finish(const std::filesystem::path& folder, const QString& error, bool complete);

  bool busy_ = false;
  Slot<ProgressReport> report_;
  QTimer timer_;
  std::jthread thread_;  // last: it stops first
};

}  // namespace beam
