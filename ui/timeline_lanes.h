// SPDX-License-Identifier: Apache-2.0
// The drawn part of the timeline: a ruler, a lane a stage, a bar of the frames in memory and a curve. One
// scale for all of them; press or drag anywhere to go to a frame.
#pragma once

#include <QStringList>
#include <QWidget>

#include <memory>
#include <string>
#include <vector>

#include "core/pipeline/take_survey.h"
#include "viewers/playback_clock.h"

namespace beam {

// What the run that is going on has before it; the survey knows only what is on the disk.
struct RunOverlay {
  std::vector<int> frames;  // in the run; empty: no run
  std::string until;        // its last stage; empty: all
  std::string running_stage;
  int running_frame = -1;  // -1: a step of the whole project
  bool active = false;
};

enum class LaneShade { Empty, Queued, Running, Done, Stale, Failed, Blocked, Interpolated };

// What lane `lane` shows of a frame.
LaneShade shadeOf(const TakeSurvey& survey, std::size_t lane, int frame, const RunOverlay& run);

class TimelineLanes final : public QWidget {
  Q_OBJECT

 public:
  explicit TimelineLanes(QWidget* parent = nullptr);

  void setSurvey(std::shared_ptr<const TakeSurvey> survey);  // null: nothing open
  void setFrame(int frame);
  void setRange(FrameRange range);
  void setMemory(std::vector<bool> held);
  void setMemoryWords(const QString& words);  // told over the bar
  void setRun(RunOverlay run);
  void setCurve(const QString& name);  // empty: none

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;
  // The frame at a position, clamped into the take; -1: there are none. And the middle of its cell.
  int frameAt(double x) const;
  double centerOf(int frame) const;

 Q_SIGNALS:
  void frameWanted(int frame);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  bool event(QEvent* event) override;

 private:
  int frames() const { return survey_ ? static_cast<int>(survey_->frames.size()) : 0; }
  QRectF cellsBox() const;
  QRectF laneBox(int lane) const;
  QRectF memoryBox() const;
  QRectF curveBox() const;
  void paintRuler(QPainter& painter) const;
  void paintLane(QPainter& painter, int lane) const;
  void paintMemory(QPainter& painter) const;
  void paintCurve(QPainter& painter) const;
  void paintMarks(QPainter& painter) const;
  QString tipAt(QPointF position) const;

  std::shared_ptr<const TakeSurvey> survey_;
  int frame_ = 0;
  FrameRange range_{0, -1};
  std::vector<bool> held_;
  RunOverlay run_;
  QString curve_, memory_words_;
};

}  // namespace beam
