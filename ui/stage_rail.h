// SPDX-License-Identifier: Apache-2.0
// The stages in a row, each with the state of the take as a shape, a colour and words. A press, or Enter on
// the cell with the focus, chooses the stage whose settings are shown. Cells give way with the room: first
// the words end in dots, then only shape, number and title are left; the tooltip tells all.
#pragma once

#include <QWidget>

#include <map>
#include <vector>

#include "ui/stage_status.h"

namespace beam {

class StageRail final : public QWidget {
  Q_OBJECT

 public:
  explicit StageRail(QWidget* parent = nullptr);

  void setStages(const std::vector<StageStatus>& stages);
  // The stage at work and how far it is; empty: none.
  void setRunning(const std::string& stage, double fraction);
  // Problems by stage.
  void setWarnings(const std::map<std::string, int>& warnings);
  void select(const std::string& stage);
  const std::string& selected() const { return selected_; }
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;
  // Where a stage stands, and what is said of it; empty: there is no such stage.
  QRect cellOf(const std::string& stage) const;
  QString wordsOf(const std::string& stage) const;
  QString tipOf(const std::string& stage) const;

 Q_SIGNALS:
  // A person pressed a stage, be it the selected one.
  void chosen(const std::string& stage);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void changeEvent(QEvent* event) override;
  bool event(QEvent* event) override;

 private:
  int count() const { return static_cast<int>(stages_.size()); }
  int indexOf(const std::string& stage) const;
  double widestTitle() const;
  double widestCell() const;
  double narrowestCell() const;
  double signSize() const;
  QRectF cell(int index) const;
  int cellAt(QPointF position) const;
  int warningsOf(const std::string& stage) const;
  QString stateText(const StageStatus& stage) const;
  QString tip(int index) const;
  void choose(int index);
  void moveCursor(int index);
  void sayWhereTheFocusIs();
  void paintCell(QPainter& painter, int index) const;
  void paintWide(QPainter& painter, const QRectF& inside, int index) const;
  void paintNarrow(QPainter& painter, const QRectF& inside, int index) const;
  double paintWarnings(QPainter& painter, const QRectF& row, int count) const;
  void paintSign(QPainter& painter, const QRectF& box, const StageStatus& stage) const;

  std::vector<StageStatus> stages_;
  std::map<std::string, int> warnings_;
  std::string selected_, running_;
  double fraction_ = 0;
  int hovered_ = -1, cursor_ = 0;  // `cursor_`: the cell that the keys are for
};

}  // namespace beam
