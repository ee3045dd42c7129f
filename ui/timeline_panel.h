// SPDX-License-Identifier: Apache-2.0
// The timeline: transport, in and out points, the rate that is reached, memory, and the lanes below.
#pragma once

#include <QWidget>

#include "ui/player.h"
#include "ui/timeline_lanes.h"

class QComboBox;
class QKeyEvent;
class QLabel;
class QToolButton;

namespace beam {

class TimelinePanel final : public QWidget {
  Q_OBJECT

 public:
  TimelinePanel(ProjectModel& model, Player& player, QWidget* parent = nullptr);

  // Space, arrows, comma and full stop, I, O, L; false: not one of ours.
  bool handleKey(const QKeyEvent& event);
  void setRun(RunOverlay run) { lanes_->setRun(std::move(run)); }
  // False: there is no such curve (yet).
  bool chooseCurve(const QString& name);
  // Beside the rate: that pictures are smaller while playing; empty: they are not.
  void setPictureNote(const QString& note);
  TimelineLanes& lanes() { return *lanes_; }
  QString text() const;  // what is said beside the buttons

 private:
  void fillCurves();
  void showState();
  void showMemory();

  ProjectModel& model_;
  Player& player_;
  TimelineLanes* lanes_;
  QToolButton *play_, *loop_, *whole_;
  QLabel* where_;
  QComboBox* curves_;
  QString note_;
  std::shared_ptr<const TakeSurvey> survey_;  // what the lanes show
};

}  // namespace beam
