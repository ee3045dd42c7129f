// SPDX-License-Identifier: Apache-2.0
// Plays the frames of the open take: moves the model's frame as the clock says and a view can follow, and
// asks for the frames ahead to be read.
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>

#include <functional>

#include "ui/project_model.h"
#include "viewers/playback_clock.h"

namespace beam {

class Player final : public QObject {
  Q_OBJECT

 public:
  // `follows`: what was last asked for is on the screen.
  Player(ProjectModel& model, std::function<bool()> follows, QObject* parent = nullptr);

  const PlaybackClock& clock() const { return clock_; }
  FrameRange range() const { return clock_.range(); }
  bool playing() const { return clock_.playing(); }

  void play();
  void pause();
  void toggle() { playing() ? pause() : play(); }
  // Of the take; clamped. Pauses.
  void goTo(int frame);
  void step(int frames) { goTo(model_.frame().value + frames); }
  void setIn(int frame);
  void setOut(int frame);
  void clearRange();
  void setLoop(bool loop);
  // Looks whether the view has followed; the view may say when it has.
  void poll();
  // "24.5 of 30 fps"; empty before there is something to say. Stays after a pause.
  QString rateText() const;

 Q_SIGNALS:
  void playingChanged();
  void rangeChanged();  // or the loop
  void rateChanged();

 private:
  double now() const { return 1e-9 * static_cast<double>(elapsed_.nsecsElapsed()); }
  void prefetch();
  void showFrame(int frame);

  ProjectModel& model_;
  std::function<bool()> follows_;
  PlaybackClock clock_;
  QElapsedTimer elapsed_;
  QTimer timer_;
  bool waiting_ = false;
  double told_s_ = 0;
};

}  // namespace beam
