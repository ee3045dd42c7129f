// SPDX-License-Identifier: Apache-2.0
#include "ui/stage_rail.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include <cmath>

namespace beam {
namespace {

constexpr int kCellWidth = 156, kHeight = 52, kGap = 6;

const QColor kQuiet("#8d939c"), kAccent("#5b9bf0"), kDone("#6fbf73"), kFailed("#e8776b"), kWaiting("#d9a84e");

}  // namespace

StageRail::StageRail(QWidget* parent) : QWidget(parent) {
  setMouseTracking(true);
  setFixedHeight(kHeight);
  setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
}

QSize StageRail::sizeHint() const {
  return {static_cast<int>(stages_.size()) * (kCellWidth + kGap), kHeight};
}

void StageRail::setStages(const std::vector<StageStatus>& stages) {
  stages_ = stages;
  setFixedWidth(sizeHint().width());
  update();
}

void StageRail::setRunning(const std::string& stage, double fraction) {
  running_ = stage;
  fraction_ = fraction;
  update();
}

void StageRail::select(const std::string& stage) {
  if (stage == selected_) return;
  selected_ = stage;
  update();
  Q_EMIT selectedChanged(stage);
}

QRectF StageRail::cell(int index) const {
  return QRectF(index * (kCellWidth + kGap) + 0.5, 3.5, kCellWidth, kHeight - 7);
}

int StageRail::cellAt(QPointF position) const {
  for (int i = 0; i < static_cast<int>(stages_.size()); ++i) {
    if (cell(i).contains(position)) return i;
  }
  return -1;
}

QString StageRail::stateText(const StageStatus& stage) const {
  if (stage.id == running_) return QString("running, %1 %").arg(static_cast<int>(100 * fraction_));
  const QString share = stage.frames > 1 ? QString(" %1/%2").arg(stage.done).arg(stage.frames) : QString();
  switch (stage.state) {
    case StepState::Done:
      return stage.done < stage.frames ? "done here," + share : QString("done");
    case StepState::Running:
      return "running elsewhere";
    case StepState::Failed:
      return "failed" + share;
    case StepState::Blocked:
      return "needs a panorama";
    case StepState::NotNeeded:
      return stage.done > 0 ? "not needed here," + share : QString("not needed");
    case StepState::Pending:
      if (stage.stale) return "stale" + share;
      return stage.done > 0 ? "not here," + share : QString("to do");
  }
  return {};
}

// Ring: to do. Half: some frames. Tick: done. Exclamation: failed. Bars: waits for something. Triangle: at
// work.
void StageRail::paintShape(QPainter& p, const QRectF& box, const StageStatus& stage) const {
  const QPointF c = box.center();
  const double r = box.width() / 2 - 1;
  const auto disc = [&](const QColor& color) {
    p.setPen(Qt::NoPen);
    p.setBrush(color);
    p.drawEllipse(c, r, r);
    p.setPen(QPen(QColor("#15171a"), 2.2, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    p.setBrush(Qt::NoBrush);
  };
  const auto ring = [&](const QColor& color) {
    p.setPen(QPen(color, 2));
    p.setBrush(Qt::NoBrush);
    p.drawEllipse(c, r, r);
  };
  if (stage.id == running_ || stage.state == StepState::Running) {
    ring(kAccent);
    p.setPen(Qt::NoPen);
    p.setBrush(kAccent);
    p.drawPolygon(QPolygonF({c + QPointF(-3, -4.5), c + QPointF(5, 0), c + QPointF(-3, 4.5)}));
    return;
  }
  switch (stage.state) {
    case StepState::Done:
      disc(kDone);
      p.drawPolyline(QPolygonF({c + QPointF(-4, 0.5), c + QPointF(-1, 3.5), c + QPointF(4, -3)}));
      break;
    case StepState::Failed:
      disc(kFailed);
      p.drawLine(c + QPointF(0, -4.5), c + QPointF(0, 1));
      p.drawPoint(c + QPointF(0, 4.5));
      break;
    case StepState::Blocked:
      ring(kWaiting);
      p.setPen(QPen(kWaiting, 2.2));
      p.drawLine(c + QPointF(-2.5, -3.5), c + QPointF(-2.5, 3.5));
      p.drawLine(c + QPointF(2.5, -3.5), c + QPointF(2.5, 3.5));
      break;
    default:
      ring(kQuiet);
      if (stage.done == 0) break;
      p.setPen(Qt::NoPen);
      p.setBrush(kQuiet);
      p.drawPie(QRectF(c - QPointF(r, r), QSizeF(2 * r, 2 * r)), 90 * 16, 180 * 16);
  }
}

void StageRail::paintCell(QPainter& p, int index) const {
  const StageStatus& stage = stages_[index];
  const QRectF box = cell(index);
  const bool chosen = stage.id == selected_;
  p.setPen(QPen(chosen ? kAccent : QColor("#383c42"), 1));
  p.setBrush(chosen ? QColor("#2a3340") : index == hovered_ ? QColor("#2d3035") : QColor("#26292d"));
  p.drawRoundedRect(box, 5, 5);
  if (stage.id == running_) {
    p.setPen(Qt::NoPen);
    p.setBrush(kAccent);
    p.drawRoundedRect(QRectF(box.left() + 4, box.bottom() - 4, (box.width() - 8) * fraction_, 2.5), 1, 1);
  }
  paintShape(p, QRectF(box.left() + 10, box.center().y() - 9, 18, 18), stage);
  const QRectF words(box.left() + 38, box.top() + 5, box.width() - 44, 18);
  QFont font = p.font();
  font.setBold(true);
  p.setFont(font);
  p.setPen(QColor("#eceef1"));
  p.drawText(words, Qt::AlignLeft | Qt::AlignVCenter, QString("%1  %2").arg(index + 1).arg(stage.title));
  font.setBold(false);
  p.setFont(font);
  p.setPen(QColor("#a0a6af"));
  p.drawText(words.translated(0, 18), Qt::AlignLeft | Qt::AlignVCenter, stateText(stage));
}

void StageRail::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  for (int i = 0; i < static_cast<int>(stages_.size()); ++i) paintCell(painter, i);
}

void StageRail::mousePressEvent(QMouseEvent* event) {
  if (const int i = cellAt(event->localPos()); i >= 0) select(stages_[i].id);
}

void StageRail::mouseMoveEvent(QMouseEvent* event) {
  hovered_ = cellAt(event->localPos());
  setCursor(hovered_ >= 0 ? Qt::PointingHandCursor : Qt::ArrowCursor);
  update();
}

void StageRail::leaveEvent(QEvent*) {
  hovered_ = -1;
  update();
}

bool StageRail::event(QEvent* event) {
  if (event->type() == QEvent::ToolTip) {
    auto* help = static_cast<QHelpEvent*>(event);
    const int i = cellAt(help->pos());
    const QString text =
        i < 0 ? QString()
              : stages_[i].summary + (stages_[i].detail.isEmpty() ? "" : "\n\n" + stages_[i].detail);
    QToolTip::showText(help->globalPos(), text, this);
    return true;
  }
  return QWidget::event(event);
}

}  // namespace beam
