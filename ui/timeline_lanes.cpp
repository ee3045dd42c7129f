// SPDX-License-Identifier: Apache-2.0
#include "ui/timeline_lanes.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>

#include "ui/theme.h"
#include "ui/words.h"

namespace beam {
namespace {

constexpr double kRight = 10, kMargin = 8;  // right of the cells; around the names of the lanes
constexpr double kMostNames = 0.3;          // share of the width that the names may take
constexpr double kLeastLane = 11, kGap = 4, kMemory = 5;
constexpr double kOvershoot = 2;  // of a failed frame, above and below its lane
constexpr int kLeastCells = 120, kAxisDigits = 4;
constexpr const char* kMemoryName = "in memory";

// 1, 2, 5, 10, ... frames between numbers.
int labelStep(double cell_width, double label_width) {
  for (int decade = 1;; decade *= 10) {
    for (const int step : {decade, 2 * decade, 5 * decade}) {
      if (step * cell_width >= label_width) return step;
    }
  }
}

struct Span {
  double low = INFINITY, high = -INFINITY;  // low above high: there is no value
};

Span limitsOf(const SurveyCurve& curve) {
  Span span;
  for (const double v : curve.values) {
    if (!std::isfinite(v)) continue;
    span.low = std::min(span.low, v);
    span.high = std::max(span.high, v);
  }
  return span;
}

// Shorter than in a tooltip, where that is no whole number.
QString axisText(double value) {
  return figureText(value == std::floor(value) ? value : QString::number(value, 'g', kAxisDigits).toDouble());
}

}  // namespace

TimelineLanes::TimelineLanes(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setAccessibleName("Frames and stages of the take");
}

double TimelineLanes::rulerHeight() const { return fontMetrics().height() + 6; }
double TimelineLanes::laneHeight() const {
  return std::max(kLeastLane, std::round(fontMetrics().height() * 0.8));
}
double TimelineLanes::curveHeight() const { return 3.5 * fontMetrics().height(); }

double TimelineLanes::namesWidth() const {
  // On a device pixel, so that cells are drawn sharp.
  const double wanted = std::min(titles_ + 2 * kMargin, kMostNames * width());
  return std::ceil(wanted * devicePixelRatioF()) / devicePixelRatioF();
}

QSize TimelineLanes::minimumSizeHint() const {
  return {kLeastCells + 8 * fontMetrics().averageCharWidth(), sizeHint().height()};
}

QSize TimelineLanes::sizeHint() const {
  const double lanes = survey_ ? static_cast<double>(survey_->lanes.size()) : 4;
  const double curve = curve_.isEmpty() ? 0 : curveHeight() + kGap;
  const double memory = std::max(kMemory, static_cast<double>(fontMetrics().height()));
  return {900,
          static_cast<int>(std::ceil(rulerHeight() + lanes * (laneHeight() + kGap) + memory + curve + kGap))};
}

void TimelineLanes::setSurvey(std::shared_ptr<const TakeSurvey> survey) {
  survey_ = std::move(survey);
  shadeLanes();
  askForHeight();
  update();
}

void TimelineLanes::shadeLanes() {
  shades_.clear();
  for (std::size_t lane = 0; survey_ && lane < survey_->lanes.size(); ++lane) {
    shades_.emplace_back();
    for (int f = 0; f < frames(); ++f) shades_.back().push_back(shadeOf(*survey_, lane, f, run_));
  }
}

void TimelineLanes::askForHeight() {
  titles_ = QFontMetrics(smallFont(font())).horizontalAdvance(kMemoryName);
  for (std::size_t i = 0; survey_ && i < survey_->lanes.size(); ++i) {
    const QString title = QString::fromStdString(survey_->lanes[i].title);
    titles_ = std::max(titles_, static_cast<double>(fontMetrics().horizontalAdvance(title)));
  }
  titles_ += 1;  // rounding must not elide what fits
  updateGeometry();
  Q_EMIT heightChanged();
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
  shadeLanes();
  update();
}

void TimelineLanes::setCurve(const QString& name, const QString& title) {
  curve_ = name;
  curve_title_ = title.isEmpty() ? name : title;
  askForHeight();
  update();
}

QRectF TimelineLanes::cellsBox() const {
  const double names = namesWidth();
  return {names, 0, std::max(10.0, width() - names - kRight), static_cast<double>(height())};
}

QRectF TimelineLanes::laneBox(int lane) const {
  const QRectF box = cellsBox();
  return {box.left(), rulerHeight() + lane * (laneHeight() + kGap), box.width(), laneHeight()};
}

// A line of text high; the bar itself is thin and in its middle.
QRectF TimelineLanes::memoryBox() const {
  const int lanes = survey_ ? static_cast<int>(survey_->lanes.size()) : 0;
  const double line = std::max(kMemory, static_cast<double>(fontMetrics().height()));
  return {cellsBox().left(), rulerHeight() + lanes * (laneHeight() + kGap), cellsBox().width(), line};
}

QRectF TimelineLanes::curveBox() const {
  return {cellsBox().left(), memoryBox().bottom() + kGap, cellsBox().width(), curveHeight()};
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
  const double cell = cellsBox().width() / frames(), foot = rulerHeight();
  const QString widest = QString::fromStdString(survey_->frames.back());
  const double label = p.fontMetrics().horizontalAdvance(widest) + 2 * kMargin;
  const int step = labelStep(cell, label);
  for (int f = 0; f < frames(); ++f) {
    const double x = centerOf(f);
    if (f % step != 0 && cell < 5) continue;
    p.setPen(QPen(f % step == 0 ? colors().muted : colors().control_edge, 1));
    p.drawLine(QPointF(x, foot - (f % step == 0 ? 6 : 4)), QPointF(x, foot - 2));
    if (f % step != 0) continue;
    const double left = std::clamp(x - label / 2, 0.0, std::max(0.0, width() - label));
    p.drawText(QRectF(left, 0, label, foot - 6), Qt::AlignHCenter | Qt::AlignVCenter,
               QString::fromStdString(survey_->frames[f]));
  }
}

void TimelineLanes::paintStage(QPainter& p, int lane) const {
  const QRectF box = laneBox(lane);
  const double names = box.left() - 2 * kMargin, line = p.fontMetrics().height();
  p.setPen(colors().muted);
  p.drawText(QRectF(kMargin, box.center().y() - line / 2, names, line), Qt::AlignLeft | Qt::AlignVCenter,
             p.fontMetrics().elidedText(QString::fromStdString(survey_->lanes[lane].title), Qt::ElideRight,
                                        static_cast<int>(names)));
  const double pixel = 1 / devicePixelRatioF();
  paintLane(p, box, lanePieces(shades_[lane], static_cast<int>(box.width() / pixel)), pixel, kOvershoot);
}

void TimelineLanes::paintMemory(QPainter& p) const {
  const QRectF row = memoryBox();
  const QRectF bar(row.left(), row.center().y() - kMemory / 2, row.width(), kMemory);
  p.fillRect(bar, colors().inside);
  const double cell = bar.width() / frames();
  for (int f = 0; f < frames() && f < static_cast<int>(held_.size()); ++f) {
    if (held_[f])
      p.fillRect(QRectF(bar.left() + f * cell, bar.top(), std::max(cell, 0.7), kMemory), colors().accent);
  }
  p.setFont(smallFont(font()));
  p.setPen(colors().quiet);
  const int names = static_cast<int>(row.left() - 2 * kMargin);
  p.drawText(QRectF(kMargin, row.top(), names, row.height()), Qt::AlignLeft | Qt::AlignVCenter,
             p.fontMetrics().elidedText(kMemoryName, Qt::ElideRight, names));
  p.setFont(font());
}

void TimelineLanes::paintCurve(QPainter& p) const {
  const SurveyCurve* curve = curve_.isEmpty() ? nullptr : survey_->curve(curve_.toStdString());
  if (curve_.isEmpty()) return;
  const QRectF box = curveBox();
  p.fillRect(box, colors().inside);
  const auto [low, high] = curve ? limitsOf(*curve) : Span{};
  p.setFont(smallFont(font()));
  p.setPen(colors().muted);
  if (low > high) {
    p.drawText(box, Qt::AlignCenter, "no values yet");
    return;
  }
  const QRectF names(0, box.top(), box.left() - kMargin / 2, box.height());
  const auto shown = [&](double value) {
    return p.fontMetrics().elidedText(axisText(value), Qt::ElideRight, static_cast<int>(names.width()));
  };
  p.drawText(names, Qt::AlignRight | Qt::AlignTop, shown(high));
  if (high > low) p.drawText(names, Qt::AlignRight | Qt::AlignBottom, shown(low));
  const auto at = [&](int f) {
    const double share = high > low ? (curve->values[f] - low) / (high - low) : 0.5;
    return QPointF(centerOf(f), box.bottom() - 5 - share * (box.height() - 10));
  };
  p.setRenderHint(QPainter::Antialiasing);
  for (int f = 0; f < frames(); ++f) {
    if (!std::isfinite(curve->values[f])) continue;
    p.setPen(QPen(colors().warning, 1.5));
    if (f + 1 < frames() && std::isfinite(curve->values[f + 1])) p.drawLine(at(f), at(f + 1));
    if (box.width() / frames() < 4) continue;
    p.setPen(Qt::NoPen);
    p.setBrush(colors().warning);
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
  if (range_.first > 0)
    p.fillRect(QRectF(box.left(), rulerHeight(), left - box.left(), bottom - rulerHeight()), dark);
  if (range_.last + 1 < frames())
    p.fillRect(QRectF(right, rulerHeight(), box.right() - right, bottom - rulerHeight()), dark);
  if (range_.first > 0 || range_.last + 1 < frames()) {
    p.setPen(Qt::NoPen);
    p.setBrush(colors().text);
    p.drawRect(QRectF(left, 2, 2, rulerHeight() - 4));
    p.drawRect(QRectF(left, rulerHeight() - 4, 6, 2));
    p.drawRect(QRectF(right - 2, 2, 2, rulerHeight() - 4));
    p.drawRect(QRectF(right - 6, rulerHeight() - 4, 6, 2));
  }
  const double x = centerOf(frame_);
  p.setRenderHint(QPainter::Antialiasing);
  p.setPen(QPen(colors().strong, 1.2));
  p.drawLine(QPointF(x, rulerHeight() - 6), QPointF(x, bottom));
  p.setPen(Qt::NoPen);
  p.setBrush(colors().strong);
  p.drawPolygon(QPolygonF(
      {QPointF(x - 5, rulerHeight() - 9), QPointF(x + 5, rulerHeight() - 9), QPointF(x, rulerHeight() - 2)}));
}

void TimelineLanes::paintEvent(QPaintEvent*) {
  QPainter p(this);
  if (frames() == 0) {
    p.setPen(colors().muted);
    p.drawText(rect(), Qt::AlignCenter, "The frames of a take appear here once a capture is open.");
    return;
  }
  paintRuler(p);
  for (int lane = 0; lane < static_cast<int>(survey_->lanes.size()); ++lane) paintStage(p, lane);
  paintMemory(p);
  paintCurve(p);
  paintMarks(p);
  if (!hasFocus()) return;
  p.setPen(QPen(colors().accent, 2));
  p.setBrush(Qt::NoBrush);
  p.drawRect(rect().adjusted(1, 1, -1, -1));
}

void TimelineLanes::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton && frames() > 0 && event->localPos().x() >= cellsBox().left() - 6)
    Q_EMIT frameWanted(frameAt(event->localPos().x()));
}

void TimelineLanes::mouseMoveEvent(QMouseEvent* event) {
  if ((event->buttons() & Qt::LeftButton) && frames() > 0) Q_EMIT frameWanted(frameAt(event->localPos().x()));
}

QString TimelineLanes::tipAt(QPointF at) const {
  if (frames() == 0) return {};
  const bool on_names = at.x() < cellsBox().left();
  const int f = frameAt(at.x());
  const QString frame = "frame " + QString::fromStdString(survey_->frames[f]);
  for (int i = 0; i < static_cast<int>(survey_->lanes.size()); ++i) {
    if (!laneBox(i).adjusted(-cellsBox().left(), -1, 0, 2).contains(at)) continue;
    const SurveyLane& lane = survey_->lanes[i];
    if (on_names)
      return "<b>" + QString::fromStdString(lane.title).toHtmlEscaped() + "</b>" +
             laneLegend(fontMetrics().height());
    const LaneShade shade = shades_[i][f];
    QString words = QString("%1, %2: %3").arg(frame, QString::fromStdString(lane.title), wordsOf(shade));
    if (shade == LaneShade::Blocked) words += "\n" + QString::fromStdString(lane.blocked_reason);
    if (!lane.notes[f].empty())
      words += "\n" + withStepTitles(stages_, QString::fromStdString(lane.notes[f]));
    return words;
  }
  if (memoryBox().adjusted(-cellsBox().left(), 0, 0, 0).contains(at)) {
    if (on_names) return memory_words_;
    const bool held = f < static_cast<int>(held_.size()) && held_[f];
    return frame + (held ? ": in memory" : ": not in memory") + "\n" + memory_words_;
  }
  const SurveyCurve* curve = curve_.isEmpty() ? nullptr : survey_->curve(curve_.toStdString());
  if (curve && curveBox().adjusted(-cellsBox().left(), 0, 0, 0).contains(at)) {
    const auto [low, high] = limitsOf(*curve);
    if (on_names)
      return curve_title_ + (low > high ? "" : "\n" + figureText(low) + " to " + figureText(high));
    const double v = curve->values[f];
    return QString("%1\n%2: %3").arg(curve_title_, frame, std::isfinite(v) ? figureText(v) : "none");
  }
  return on_names ? QString() : frame;
}

void TimelineLanes::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) askForHeight();
}

void TimelineLanes::focusInEvent(QFocusEvent*) { update(); }
void TimelineLanes::focusOutEvent(QFocusEvent*) { update(); }

bool TimelineLanes::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  auto* help = static_cast<QHelpEvent*>(event);
  QToolTip::showText(help->globalPos(), tipAt(help->pos()), this);
  return true;
}

}  // namespace beam
