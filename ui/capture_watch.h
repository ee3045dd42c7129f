// SPDX-License-Identifier: Apache-2.0
// Looks after the capture of the open project: whether its folder is still there, and once, in the
// background, what `beam check` says of its pictures.
#pragma once

#include <QObject>
#include <QStringList>
#include <QTimer>

#include "ui/background_task.h"
#include "ui/studio_services.h"
#include "viewers/latest_worker.h"

namespace beam {

class CaptureWatch final : public QObject {
  Q_OBJECT

 public:
  explicit CaptureWatch(QObject* parent = nullptr);

  // From now on of this project. `check` may be empty: then pictures are not looked at.
  void start(const Project& project, const CaptureCheck& check);
  void stop();
  bool isThere() const { return there_; }

 Q_SIGNALS:
  void lost();
  void back();
  void checked(const QStringList& warnings);  // each once, may be none

 private:
  void look();
  void checkWhenFree();

  std::optional<Project> project_;
  CaptureCheck due_;  // not begun yet: the check of another capture is still stopping
  bool there_ = true;
  std::uint64_t ticket_ = 0;
  QTimer timer_;
  BackgroundTask check_;
  LatestWorker worker_;  // last: it stops first. A share on the network may take its time to answer
};

}  // namespace beam
