// SPDX-License-Identifier: Apache-2.0
// The timeline: transport, in and out points, the rate that is reached, memory, and the lanes below, which
// scroll where the dock is lower than they are. What of the row does not fit folds into a menu.
#pragma once

#include <QWidget>

#include <functional>
#include <vector>

#include "ui/player.h"
#include "ui/timeline_lanes.h"

class QAction;
class QHBoxLayout;
class QKeyEvent;
class QScrollArea;
class QToolButton;

namespace beam {

class ElidedLabel;
class QuietCombo;

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
  QSize minimumSizeHint() const override;

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void changeEvent(QEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  QHBoxLayout* makeTransport();
  QToolButton* foldable(QHBoxLayout* row, QAction*& action, const QString& text, std::function<void()> act);
  void makePoints(QHBoxLayout* row);
  void connectModel();
  void fold();
  void fitHeight();
  void showIcons();
  void fillCurves();
  void showCurve();
  void revealCurve();
  void showState();
  void showMemory();

  ProjectModel& model_;
  Player& player_;
  TimelineLanes* lanes_;
  QScrollArea* scroll_ = nullptr;
  QToolButton *back_ = nullptr, *play_ = nullptr, *next_ = nullptr;
  QAction *to_in_ = nullptr, *to_out_ = nullptr;
  QAction *loop_ = nullptr, *in_ = nullptr, *out_ = nullptr, *whole_ = nullptr;
  std::vector<QToolButton*> foldable_;  // the first is the last to go
  QToolButton* more_ = nullptr;         // what is folded away
  ElidedLabel* where_ = nullptr;
  QuietCombo* curves_ = nullptr;
  QString note_;
  std::shared_ptr<const TakeSurvey> survey_;  // what the lanes show
};

}  // namespace beam
