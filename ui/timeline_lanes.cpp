// SPDX-License-Identifier: Apache-2.0
#include "ui/timeline_lanes.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

constexpr double kNames = 112, kRight = 10;  // left of the cells the names of the lanes; margin
constexpr double kRuler = 20, kLane = 13, kGap = 3, kMemory = 5, kCurve = 54;
constexpr double kLeastLabel = 60;  // between numbers of the ruler

const QColor kText("#a0a6af"), kFaint("#383c42"), kAccent("#5b9bf0"), kInside("#26292d");
const char* const kShadeWords[] = {"to do",
                                   "queued",
                                   "running",
                                   "done",
                                   "stale: made with other settings",
                                   "failed",
                                   "blocked",
                                   "interpolated between solved frames"};

QColor colorOf(LaneShade shade) {
  switch (shade) {
    case LaneShade::Empty:
      return QColor("#363a40");
    case LaneShade::Queued:
      return QColor("#40536d");
    case LaneShade::Running:
      return kAccent;
    case LaneShade::Done:
      return QColor("#5b9a5f");
    case LaneShade::Stale:
      return QColor("#8a7a4a");
    case LaneShade::Failed:
      return QColor("#d9604f");
    case LaneShade::Blocked:
      return QColor("#3c3527");
    case LaneShade::Interpolated:
      return QColor("#39493b");
  }
  return {};
}

// Where several frames share a pixel the one that asks for attention is seen.
int rankOf(LaneShade shade) {
  constexpr int kRanks[] = {3, 4, 7, 0, 5, 8, 2, 1};  // by LaneShade
  return kRanks[static_cast<int>(shade)];
}

// 1, 2, 5, 10, ... frames between numbers.
int labelStep(double cell_width) {
  for (int decade = 1;; decade *= 10) {
    for (const int step : {decade, 2 * decade, 5 * decade}) {
      if (step * cell_width >= kLeastLabel) return step;
    }
  }
}

}  // namespace

LaneShade shadeOf(const TakeSurvey& survey, std::size_t lane, int frame, const RunOverlay& run) {
  const SurveyLane& row = survey.lanes[lane];
  const CellState cell = row.cells[static_cast<std::size_t>(frame)];
  const bool in_run =
      run.active && std::find(run.frames.begin(), run.frames.end(), frame) != run.frames.end();
  if (run.active && row.stage == run.running_stage && cell != CellState::Done &&
      (run.running_frame == frame || (run.running_frame < 0 && in_run))) {
    return LaneShade::Running;
  }
  bool before_end = true;
  for (std::size_t i = 0; i < lane; ++i) before_end = before_end && survey.lanes[i].stage != run.until;
  switch (cell) {
    case CellState::Running:
      return LaneShade::Running;
    case CellState::Done:
      return LaneShade::Done;
    case CellState::Failed:
      return LaneShade::Failed;
    case CellState::Blocked:
      return LaneShade::Blocked;
    case CellState::Stale:
      return in_run && before_end ? LaneShade::Queued : LaneShade::Stale;
    case CellState::NotNeeded:
      return LaneShade::Empty;
    case CellState::Interpolated:
      return in_run && before_end ? LaneShade::Queued : LaneShade::Interpolated;
    case CellState::Empty:
      break;
  }
  return in_run && before_end ? LaneShade::Queued : LaneShade::Empty;
}

TimelineLanes::TimelineLanes(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setMouseTracking(true);
}

QSize TimelineLanes::minimumSizeHint() const { return {300, sizeHint().height()}; }

QSize TimelineLanes::sizeHint() const {
  const double lanes = survey_ ? static_cast<double>(survey_->lanes.size()) : 4;
  const double curve = curve_.isEmpty() ? 0 : kCurve + kGap;
  return {900, static_cast<int>(kRuler + lanes * (kLane + kGap) + kMemory + 2 * kGap + curve + 4)};
}

void TimelineLanes::setSurvey(std::shared_ptr<const TakeSurvey> survey) {
  survey_ = std::move(survey);
  updateGeometry();
  update();
}

void TimelineLanes::setFrame(int frame) {
  frame_ = frame;
  update();
}

void TimelineLanes::setRange(FrameRange range) {
  range_ = range;
  update();
}

void TimelineLanes::setMemory(std::vector<bool> held) {
  held_ = std::move(held);
  update();
}

void TimelineLanes::setMemoryWords(const QString& words) { memory_words_ = words; }

void TimelineLanes::setRun(RunOverlay run) {
  run_ = std::move(run);
  update();
}

void TimelineLanes::setCurve(const QString& name) {
  curve_ = name;
  updateGeometry();
  update();
}

QRectF TimelineLanes::cellsBox() const {
  return {kNames, 0, std::max(10.0, width() - kNames - kRight), static_cast<double>(height())};
}

QRectF TimelineLanes::laneBox(int lane) const {
  const QRectF box = cellsBox();
  return {box.left(), kRuler + lane * (kLane + kGap), box.width(), kLane};
}

QRectF TimelineLanes::memoryBox() const {
  const int lanes = survey_ ? static_cast<int>(survey_->lanes.size()) : 0;
  return {cellsBox().left(), kRuler + lanes * (kLane + kGap), cellsBox().width(), kMemory};
}

QRectF TimelineLanes::curveBox() const {
  return {cellsBox().left(), memoryBox().bottom() + 2 * kGap, cellsBox().width(), kCurve};
}

int TimelineLanes::frameAt(double x) const {
  if (frames() == 0) return -1;
  const QRectF box = cellsBox();
  return std::clamp(static_cast<int>(std::floor((x - box.left()) / box.width() * frames())), 0, frames() - 1);
}

double TimelineLanes::centerOf(int frame) const {
  return cellsBox().left() + (frame + 0.5) * cellsBox().width() / std::max(frames(), 1);
}

void TimelineLanes::paintRuler(QPainter& p) const {
  const double cell = cellsBox().width() / frames();
  const int step = labelStep(cell);
  for (int f = 0; f < frames(); ++f) {
    const double x = centerOf(f);
    if (f % step != 0 && cell < 5) continue;
    p.setPen(QPen(f % step == 0 ? kText : kFaint, 1));
    p.drawLine(QPointF(x, kRuler - (f % step == 0 ? 6 : 4)), QPointF(x, kRuler - 2));
    if (f % step == 0) {
      p.drawText(QRectF(x - 60, 0, 120, kRuler - 6), Qt::AlignHCenter | Qt::AlignVCenter,
                 QString::fromStdString(survey_->frames[f]));
    }
  }
}

void TimelineLanes::paintLane(QPainter& p, int lane) const {
  const QRectF box = laneBox(lane);
  const double cell = box.width() / frames();
  p.setPen(kText);
  p.drawText(QRectF(8, box.top() - 2, kNames - 16, kLane + 4), Qt::AlignLeft | Qt::AlignVCenter,
             QString::fromStdString(survey_->lanes[lane].title));
  p.setPen(Qt::NoPen);
  const double seam = cell > 4 ? 1 : 0;
  for (int f = 0; f < frames();) {
    LaneShade shade = shadeOf(*survey_, lane, f, run_);
    int next = f + 1;
    for (; next < frames() && (next - f + 1) * cell < 1; ++next) {
      const LaneShade other = shadeOf(*survey_, lane, next, run_);
      if (rankOf(other) > rankOf(shade)) shade = other;
    }
    const QRectF piece(box.left() + f * cell, box.top(), std::max((next - f) * cell - seam, 0.7), kLane);
    p.fillRect(piece, colorOf(shade));
    if (shade == LaneShade::Interpolated)
      p.fillRect(piece, QBrush(colorOf(LaneShade::Done), Qt::BDiagPattern));
    if (shade == LaneShade::Stale) {
      p.setPen(QPen(QColor("#d9a84e"), 1, Qt::DashLine));
      p.drawLine(piece.topLeft() + QPointF(0, 0.5), piece.topRight() + QPointF(0, 0.5));
      p.setPen(Qt::NoPen);
    }
    f = next;
  }
}

void TimelineLanes::paintMemory(QPainter& p) const {
  const QRectF box = memoryBox();
  p.fillRect(box, kInside);
  const double cell = box.width() / frames();
  for (int f = 0; f < frames() && f < static_cast<int>(held_.size()); ++f) {
    if (held_[f]) p.fillRect(QRectF(box.left() + f * cell, box.top(), std::max(cell, 0.7), kMemory), kAccent);
  }
  QFont font = p.font();
  font.setPixelSize(11);
  p.setFont(font);
  p.setPen(QColor("#757b84"));
  p.drawText(QRectF(8, box.center().y() - 8, kNames - 16, 16), Qt::AlignLeft | Qt::AlignVCenter, "in memory");
}

void TimelineLanes::paintCurve(QPainter& p) const {
  const SurveyCurve* curve = curve_.isEmpty() ? nullptr : survey_->curve(curve_.toStdString());
  if (curve_.isEmpty()) return;
  const QRectF box = curveBox();
  p.fillRect(box, kInside);
  double low = INFINITY, high = -INFINITY;
  for (const double v : curve ? curve->values : std::vector<double>()) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  QFont font = p.font();
  font.setPixelSize(11);
  p.setFont(font);
  p.setPen(kText);
  if (low > high) {
    p.drawText(box, Qt::AlignCenter, "no values yet");
    return;
  }
  const QRectF names(8, box.top(), kNames - 14, box.height());
  p.drawText(names, Qt::AlignRight | Qt::AlignTop, QString::number(high, 'g', 5));
  if (high > low) p.drawText(names, Qt::AlignRight | Qt::AlignBottom, QString::number(low, 'g', 5));
  const auto at = [&](int f) {
    const double share = high > low ? (curve->values[f] - low) / (high - low) : 0.5;
    return QPointF(centerOf(f), box.bottom() - 5 - share * (box.height() - 10));
  };
  p.setRenderHint(QPainter::Antialiasing);
  for (int f = 0; f < frames(); ++f) {
    if (!std::isfinite(curve->values[f])) continue;
    p.setPen(QPen(QColor("#d9a84e"), 1.5));
    if (f + 1 < frames() && std::isfinite(curve->values[f + 1])) p.drawLine(at(f), at(f + 1));
    if (box.width() / frames() < 4) continue;
    p.setPen(Qt::NoPen);
    p.setBrush(QColor("#d9a84e"));
    p.drawEllipse(at(f), 2.2, 2.2);
  }
  p.setRenderHint(QPainter::Antialiasing, false);
}

// In and out points as brackets, what lies outside darkened; the frame as a line through everything.
void TimelineLanes::paintMarks(QPainter& p) const {
  const QRectF box = cellsBox();
  const double cell = box.width() / frames();
  const double left = box.left() + range_.first * cell, right = box.left() + (range_.last + 1) * cell;
  const double bottom = curve_.isEmpty() ? memoryBox().bottom() : curveBox().bottom();
  const QColor dark(20, 21, 23, 150);
  if (range_.first > 0) p.fillRect(QRectF(box.left(), kRuler, left - box.left(), bottom - kRuler), dark);
  if (range_.last + 1 < frames())
    p.fillRect(QRectF(right, kRuler, box.right() - right, bottom - kRuler), dark);
  if (range_.first > 0 || range_.last + 1 < frames()) {
    p.setPen(Qt::NoPen);
    p.setBrush(QColor("#d9dce1"));
    p.drawRect(QRectF(left, 2, 2, kRuler - 4));
    p.drawRect(QRectF(left, kRuler - 4, 6, 2));
    p.drawRect(QRectF(right - 2, 2, 2, kRuler - 4));
    p.drawRect(QRectF(right - 6, kRuler - 4, 6, 2));
  }
  const double x = centerOf(frame_);
  p.setRenderHint(QPainter::Antialiasing);
  p.setPen(QPen(Qt::white, 1.2));
  p.drawLine(QPointF(x, kRuler - 6), QPointF(x, bottom));
  p.setPen(Qt::NoPen);
  p.setBrush(Qt::white);
  p.drawPolygon(QPolygonF({QPointF(x - 5, kRuler - 9), QPointF(x + 5, kRuler - 9), QPointF(x, kRuler - 2)}));
}

void TimelineLanes::paintEvent(QPaintEvent*) {
  QPainter p(this);
  if (frames() == 0) {
    p.setPen(kText);
    p.drawText(rect(), Qt::AlignCenter, "The frames of a take appear here once a capture is open.");
    return;
  }
  QFont font = p.font();
  font.setPixelSize(12);
  p.setFont(font);
  paintRuler(p);
  for (int lane = 0; lane < static_cast<int>(survey_->lanes.size()); ++lane) paintLane(p, lane);
  paintMemory(p);
  paintCurve(p);
  paintMarks(p);
}

void TimelineLanes::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton && frames() > 0 && event->localPos().x() >= kNames - 6)
    Q_EMIT frameWanted(frameAt(event->localPos().x()));
}

void TimelineLanes::mouseMoveEvent(QMouseEvent* event) {
  if ((event->buttons() & Qt::LeftButton) && frames() > 0) Q_EMIT frameWanted(frameAt(event->localPos().x()));
}

QString TimelineLanes::tipAt(QPointF at) const {
  if (frames() == 0 || at.x() < kNames) return {};
  const int f = frameAt(at.x());
  const QString frame = "frame " + QString::fromStdString(survey_->frames[f]);
  for (int i = 0; i < static_cast<int>(survey_->lanes.size()); ++i) {
    if (!laneBox(i).adjusted(0, -1, 0, 2).contains(at)) continue;
    const SurveyLane& lane = survey_->lanes[i];
    const LaneShade shade = shadeOf(*survey_, i, f, run_);
    QString words = QString("%1, %2: %3")
                        .arg(frame, QString::fromStdString(lane.title), kShadeWords[static_cast<int>(shade)]);
    if (shade == LaneShade::Blocked) words += "\n" + QString::fromStdString(lane.blocked_reason);
    if (!lane.notes[f].empty()) words += "\n" + QString::fromStdString(lane.notes[f]);
    return words;
  }
  const SurveyCurve* curve = curve_.isEmpty() ? nullptr : survey_->curve(curve_.toStdString());
  if (curve && curveBox().contains(at)) {
    const double v = curve->values[f];
    return QString("%1: %2 %3").arg(frame, curve_, std::isfinite(v) ? QString::number(v, 'g', 6) : "none");
  }
  if (memoryBox().adjusted(0, -2, 0, 3).contains(at)) {
    const bool held = f < static_cast<int>(held_.size()) && held_[f];
    return frame + (held ? ": in memory" : ": not in memory") + "\n" + memory_words_;
  }
  return frame;
}

bool TimelineLanes::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  auto* help = static_cast<QHelpEvent*>(event);
  QToolTip::showText(help->globalPos(), tipAt(help->pos()), this);
  return true;
}

}  // namespace beam
