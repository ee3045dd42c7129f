// SPDX-License-Identifier: Apache-2.0
// The drawn part of the timeline: a ruler, a lane a stage, a bar of the frames in memory and a curve. One
// scale for all of them; press or drag anywhere to go to a frame. As high as the text asks for.
#pragma once

#include <QWidget>

#include <memory>
#include <string>
#include <vector>

#include "core/pipeline/stage_registry.h"
#include "ui/lane_shades.h"
#include "viewers/playback_clock.h"

namespace beam {

class TimelineLanes final : public QWidget {
  Q_OBJECT

 public:
  explicit TimelineLanes(QWidget* parent = nullptr);

  // Whose titles stand for the ids in what is noted of a frame.
  void setStages(const std::vector<StageInfo>& stages) { stages_ = stages; }
  void setSurvey(std::shared_ptr<const TakeSurvey> survey);  // null: nothing open
  void setFrame(int frame);
  void setRange(FrameRange range);
  void setMemory(std::vector<bool> held);
  void setMemoryWords(const QString& words);  // told over the bar
  void setRun(RunOverlay run);
  // Its name in the survey and what it is called; empty: none.
  void setCurve(const QString& name, const QString& title = {});

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;
  // The frame at a position, clamped into the take; -1: there are none. And the middle of its cell.
  int frameAt(double x) const;
  double centerOf(int frame) const;
  // Where the cells of a lane are drawn, and the curve.
  QRectF laneBox(int lane) const;
  QRectF curveBox() const;

 Q_SIGNALS:
  void frameWanted(int frame);
  void heightChanged();  // another height is asked for

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void changeEvent(QEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  bool event(QEvent* event) override;

 private:
  int frames() const { return survey_ ? static_cast<int>(survey_->frames.size()) : 0; }
  double namesWidth() const;
  double rulerHeight() const;
  double laneHeight() const;
  double curveHeight() const;
  QRectF cellsBox() const;
  QRectF memoryBox() const;
  void shadeLanes();
  void askForHeight();
  void paintRuler(QPainter& painter) const;
  void paintStage(QPainter& painter, int lane) const;
  void paintMemory(QPainter& painter) const;
  void paintCurve(QPainter& painter) const;
  void paintMarks(QPainter& painter) const;
  QString tipAt(QPointF position) const;

  std::shared_ptr<const TakeSurvey> survey_;
  std::vector<StageInfo> stages_;
  double titles_ = 0;  // width of the widest
  int frame_ = 0;
  FrameRange range_{0, -1};
  std::vector<bool> held_;
  RunOverlay run_;
  QString curve_, curve_title_, memory_words_;
  std::vector<std::vector<LaneShade>> shades_;  // by lane and frame
};

}  // namespace beam
