// SPDX-License-Identifier: Apache-2.0
// What the command line asks of the window once it stands: open, show, run, take a picture and leave.
#pragma once

#include <QElapsedTimer>
#include <QTimer>

#include "app/gui/arguments.h"

namespace beam {

class Errand final : public QObject {
  Q_OBJECT

 public:
  Errand(MainWindow& window, const StudioArguments& arguments);

 private:
  void show();  // the project is open
  void tick();
  bool playing();  // as it was asked to; starts it
  void reportPlay();
  void takePicture();
  std::optional<FrameIndex> frameNamed(const QString& name) const;
  void giveUp(const QString& why);
  std::optional<ViewIndex> cameraNamed(const QString& name) const;

  MainWindow& window_;
  StudioArguments arguments_;
  QTimer timer_;
  QElapsedTimer settled_since_;
  bool shown_ = false, values_came_ = false, run_started_ = false, played_ = false;
  QElapsedTimer play_since_;
};

}  // namespace beam
