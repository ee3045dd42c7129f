// SPDX-License-Identifier: Apache-2.0
// The stages in a row, each with its state as a shape, a colour and a word. A click chooses the stage whose
// settings are shown.
#pragma once

#include <QWidget>

#include "ui/project_model.h"

namespace beam {

class StageRail final : public QWidget {
  Q_OBJECT

 public:
  explicit StageRail(QWidget* parent = nullptr);

  void setStages(const std::vector<StageStatus>& stages);
  // The stage at work and how far it is; empty: none.
  void setRunning(const std::string& stage, double fraction);
  void select(const std::string& stage);
  const std::string& selected() const { return selected_; }
  QSize sizeHint() const override;

 Q_SIGNALS:
  void selectedChanged(const std::string& stage);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;
  bool event(QEvent* event) override;

 private:
  QRectF cell(int index) const;
  int cellAt(QPointF position) const;
  QString stateText(const StageStatus& stage) const;
  void paintCell(QPainter& painter, int index) const;
  void paintShape(QPainter& painter, const QRectF& box, const StageStatus& stage) const;

  std::vector<StageStatus> stages_;
  std::string selected_, running_;
  double fraction_ = 0;
  int hovered_ = -1;
};

}  // namespace beam
