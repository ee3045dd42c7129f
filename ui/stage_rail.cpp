// SPDX-License-Identifier: Apache-2.0
#include "ui/stage_rail.h"

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>

#include "ui/theme.h"
#include "ui/words.h"

namespace beam {
namespace {

constexpr double kGap = 4, kPad = 6, kEdge = 3;
constexpr int kMostLetters = 15,
              kLeastLetters = 5;  // of a cell's words at its widest, of its title at the least

QFont bold(QFont font) {
  font.setBold(true);
  return font;
}

// "1  Surface"
QString titleOf(const StageStatus& stage, int index) {
  return QString("%1  %2").arg(index + 1).arg(stage.title);
}

// Signs on a disc or ring of radius 1.
QPolygonF scaled(QPointF center, double r, std::initializer_list<QPointF> points) {
  QPolygonF polygon;
  for (const QPointF& point : points) polygon << center + r * point;
  return polygon;
}

}  // namespace

StageRail::StageRail(QWidget* parent) : QWidget(parent) {
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  setAccessibleName("Stages");
}

double StageRail::signSize() const { return std::max(16.0, fontMetrics().ascent() * 1.25); }

double StageRail::widestTitle() const {
  const QFontMetrics strong(bold(font()));
  double widest = 0;
  for (int i = 0; i < count(); ++i)
    widest = std::max(widest, static_cast<double>(strong.horizontalAdvance(titleOf(stages_[i], i))));
  return widest;
}

double StageRail::widestCell() const {
  const double words = kMostLetters * fontMetrics().averageCharWidth();
  return signSize() + std::max(words, widestTitle()) + 4 * kPad;
}

double StageRail::narrowestCell() const {
  const QFontMetrics strong(bold(font()));
  const double sign_row = signSize() + strong.horizontalAdvance("8") + kPad;
  return 2 * kPad + std::max(sign_row, static_cast<double>(kLeastLetters * strong.averageCharWidth()));
}

QSize StageRail::sizeHint() const {
  const int height = static_cast<int>(std::ceil(2 * fontMetrics().height() + 2 * kEdge + kPad));
  return {static_cast<int>(std::ceil(count() * (widestCell() + kGap))), height};
}

QSize StageRail::minimumSizeHint() const {
  return {static_cast<int>(std::ceil(count() * (narrowestCell() + kGap))), sizeHint().height()};
}

void StageRail::setStages(const std::vector<StageStatus>& stages) {
  const bool same = stages.size() == stages_.size();
  stages_ = stages;
  cursor_ = std::clamp(cursor_, 0, std::max(0, count() - 1));
  if (!same) updateGeometry();
  sayWhereTheFocusIs();
  update();
}

void StageRail::setRunning(const std::string& stage, double fraction) {
  running_ = stage;
  fraction_ = std::clamp(fraction, 0.0, 1.0);
  update();
}

void StageRail::setWarnings(const std::map<std::string, int>& warnings) {
  warnings_ = warnings;
  update();
}

void StageRail::select(const std::string& stage) {
  if (const int i = indexOf(stage); i >= 0) moveCursor(i);
  if (stage == selected_) return;
  selected_ = stage;
  update();
}

void StageRail::choose(int index) {
  const std::string stage = stages_[index].id;  // a listener may bring new stages
  select(stage);
  Q_EMIT chosen(stage);
}

int StageRail::indexOf(const std::string& stage) const {
  for (int i = 0; i < count(); ++i) {
    if (stages_[i].id == stage) return i;
  }
  return -1;
}

QRectF StageRail::cell(int index) const {
  const double room = static_cast<double>(width()) / std::max(1, count()) - kGap;
  const double w = std::min(widestCell(), room);
  return {index * (w + kGap) + 0.5, 1.5, w, height() - 3.0};
}

int StageRail::cellAt(QPointF position) const {
  for (int i = 0; i < count(); ++i) {
    if (cell(i).contains(position)) return i;
  }
  return -1;
}

QRect StageRail::cellOf(const std::string& stage) const {
  const int i = indexOf(stage);
  return i < 0 ? QRect() : cell(i).toAlignedRect();
}

QString StageRail::wordsOf(const std::string& stage) const {
  const int i = indexOf(stage);
  return i < 0 ? QString() : stateText(stages_[i]);
}

QString StageRail::tipOf(const std::string& stage) const {
  const int i = indexOf(stage);
  return i < 0 ? QString() : tip(i);
}

int StageRail::warningsOf(const std::string& stage) const {
  const auto found = warnings_.find(stage);
  return found == warnings_.end() ? 0 : found->second;
}

QString StageRail::stateText(const StageStatus& stage) const {
  if (stage.id != running_) return stageWords(stage);
  const QString running = QString("running, %1 %").arg(static_cast<int>(100 * fraction_));
  return stage.failed > 0 ? running + QString(", %1 failed").arg(stage.failed) : running;
}

QString StageRail::tip(int index) const {
  const StageStatus& stage = stages_[index];
  QString text = QString("%1  ").arg(index + 1) + stageTip(stage);  // as the cell begins
  if (!isEnabled()) text += "\nOpen a capture or a project first.";
  if (stage.id == running_) text += "\nNow: " + stateText(stage);
  if (const int warnings = warningsOf(stage.id); warnings > 0)
    text += "\n" + countText(warnings, "problem") + " of this stage, listed under Problems";
  return text;
}

// Ring: to do, or nothing is open. Ring with a dash: not needed. Half: some frames. Tick: all of them. Dashed
// ring: stale. Exclamation mark: failed. Bars: waits for something. Triangle: at work.
void StageRail::paintSign(QPainter& p, const QRectF& box, const StageStatus& stage) const {
  const Colors& color = colors();
  const QPointF c = box.center();
  const double r = box.width() / 2 - 1;
  const auto disc = [&](const QColor& fill) {
    p.setPen(Qt::NoPen);
    p.setBrush(fill);
    p.drawEllipse(c, r, r);
    p.setPen(QPen(color.on_mark, r / 3.6, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    p.setBrush(Qt::NoBrush);
  };
  const auto ring = [&](const QColor& line, Qt::PenStyle style = Qt::SolidLine) {
    QPen pen(line, 2, style, Qt::FlatCap);
    if (style == Qt::CustomDashLine) pen.setDashPattern({r / 4, r / 4});
    p.setPen(pen);
    p.setBrush(Qt::NoBrush);
    p.drawEllipse(c, r, r);
  };
  switch (stage.id == running_ ? StageMark::Running : markOf(stage)) {
    case StageMark::Running:
      ring(color.running);
      p.setPen(Qt::NoPen);
      p.setBrush(color.running);
      p.drawPolygon(scaled(c, r, {{-0.35, -0.55}, {0.6, 0}, {-0.35, 0.55}}));
      break;
    case StageMark::Done:
      disc(color.done);
      p.drawPolyline(scaled(c, r, {{-0.5, 0.06}, {-0.12, 0.44}, {0.5, -0.38}}));
      break;
    case StageMark::Failed:
      disc(color.failed);
      p.drawLine(c + r * QPointF(0, -0.56), c + r * QPointF(0, 0.12));
      p.drawPoint(c + r * QPointF(0, 0.56));
      break;
    case StageMark::Stale:
      ring(color.stale, Qt::CustomDashLine);
      break;
    case StageMark::Blocked:
      ring(color.warning);
      p.drawLine(c + r * QPointF(-0.28, -0.42), c + r * QPointF(-0.28, 0.42));
      p.drawLine(c + r * QPointF(0.28, -0.42), c + r * QPointF(0.28, 0.42));
      break;
    case StageMark::Partly:
      ring(color.done);
      p.setPen(Qt::NoPen);
      p.setBrush(color.done);
      p.drawPie(QRectF(c - QPointF(r, r), QSizeF(2 * r, 2 * r)), 90 * 16, 180 * 16);
      break;
    case StageMark::NotNeeded:
      ring(color.disabled);
      p.drawLine(c + r * QPointF(-0.4, 0), c + r * QPointF(0.4, 0));
      break;
    case StageMark::Closed:
    case StageMark::Nothing:
      ring(color.quiet);
      break;
  }
}

// At the right end of the row; returns the width that it took.
double StageRail::paintWarnings(QPainter& p, const QRectF& row, int count) const {
  if (count == 0) return 0;
  const QString number = count > 99 ? QString("99+") : QString::number(count);
  p.setFont(smallFont(font()));
  const double words = p.fontMetrics().horizontalAdvance(number), side = p.fontMetrics().ascent();
  const double left = row.right() - words - side - 2;
  const double top = row.center().y() - side / 2;
  p.setPen(Qt::NoPen);
  p.setBrush(colors().warning);
  p.drawPolygon(QPolygonF({{left, top + side}, {left + side / 2, top}, {left + side, top + side}}));
  p.setPen(colors().warning);
  p.drawText(QRectF(left + side + 2, row.top(), words + 2, row.height()), Qt::AlignLeft | Qt::AlignVCenter,
             number);
  p.setFont(font());
  return row.right() - left + kPad / 2;
}

void StageRail::paintWide(QPainter& p, const QRectF& inside, int index) const {
  const StageStatus& stage = stages_[index];
  const double sign = signSize(), line = fontMetrics().height();
  paintSign(p, QRectF(inside.left(), inside.center().y() - sign / 2, sign, sign), stage);
  const QString words = stateText(stage);
  const double top = inside.center().y() - (words.isEmpty() ? line / 2 : line);
  QRectF row(inside.left() + sign + kPad, top, inside.width() - sign - kPad, line);
  const double taken = paintWarnings(p, row, warningsOf(stage.id));
  p.setFont(bold(font()));
  p.setPen(colors().strong);
  p.drawText(row, Qt::AlignLeft | Qt::AlignVCenter,
             p.fontMetrics().elidedText(titleOf(stage, index), Qt::ElideRight,
                                        static_cast<int>(row.width() - taken)));
  row.translate(0, line);
  p.setFont(font());
  p.setPen(colors().muted);
  p.drawText(row, Qt::AlignLeft | Qt::AlignVCenter,
             p.fontMetrics().elidedText(words, Qt::ElideRight, static_cast<int>(row.width())));
}

void StageRail::paintNarrow(QPainter& p, const QRectF& inside, int index) const {
  const StageStatus& stage = stages_[index];
  const double sign = signSize(), line = fontMetrics().height();
  QRectF row(inside.left(), inside.center().y() - line, inside.width(), line);
  paintSign(p, QRectF(row.left(), row.center().y() - sign / 2, sign, sign), stage);
  p.setFont(bold(font()));
  p.setPen(colors().strong);
  const QString number = QString::number(index + 1);
  const double used = sign + kPad + p.fontMetrics().horizontalAdvance(number) + kPad;
  p.drawText(row.adjusted(sign + kPad, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter, number);
  const int warnings = warningsOf(stage.id);
  if (row.width() - used > 2.4 * line) paintWarnings(p, row, warnings);
  row.translate(0, line);
  p.setFont(bold(font()));
  p.setPen(colors().strong);
  p.drawText(row, Qt::AlignLeft | Qt::AlignVCenter,
             p.fontMetrics().elidedText(stage.title, Qt::ElideRight, static_cast<int>(row.width())));
  p.setFont(font());
}

void StageRail::paintCell(QPainter& p, int index) const {
  const Colors& color = colors();
  const StageStatus& stage = stages_[index];
  const QRectF box = cell(index);
  const bool is_chosen = stage.open && stage.id == selected_;
  p.setPen(QPen(is_chosen ? color.accent : color.control_edge, 1));
  p.setBrush(is_chosen ? color.chosen : index == hovered_ ? color.hover : color.card);
  p.drawRoundedRect(box, 5, 5);
  if (stage.id == running_) {
    p.setPen(Qt::NoPen);
    p.setBrush(color.accent);
    const double width = (box.width() - 8) * fraction_;
    p.drawRect(QRectF(box.left() + 4, box.bottom() - 3.5, width, 2.5));
  }
  const QRectF inside = box.adjusted(kPad, kEdge, -kPad, -kEdge);
  if (inside.width() >= signSize() + kPad + widestTitle()) {
    paintWide(p, inside, index);
  } else {
    paintNarrow(p, inside, index);
  }
  if (!hasFocus() || index != cursor_) return;
  p.setPen(QPen(color.accent, 2));
  p.setBrush(Qt::NoBrush);
  p.drawRoundedRect(box.adjusted(1, 1, -1, -1), 4, 4);
  p.setPen(QPen(color.strong, 1, Qt::DotLine));
  p.drawRoundedRect(box.adjusted(3, 3, -3, -3), 3, 3);
}

void StageRail::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  if (!isEnabled()) painter.setOpacity(0.5);
  for (int i = 0; i < count(); ++i) paintCell(painter, i);
}

void StageRail::mousePressEvent(QMouseEvent* event) {
  const int i = cellAt(event->localPos());
  if (event->button() == Qt::LeftButton && i >= 0) choose(i);
}

void StageRail::mouseMoveEvent(QMouseEvent* event) {
  hovered_ = cellAt(event->localPos());
  setCursor(hovered_ >= 0 ? Qt::PointingHandCursor : Qt::ArrowCursor);
  update();
}

void StageRail::keyPressEvent(QKeyEvent* event) {
  const bool plain = !(event->modifiers() & ~Qt::KeypadModifier);
  if (count() == 0 || !plain) return QWidget::keyPressEvent(event);
  switch (event->key()) {
    case Qt::Key_Left:
      return moveCursor(std::max(0, cursor_ - 1));
    case Qt::Key_Right:
      return moveCursor(std::min(count() - 1, cursor_ + 1));
    case Qt::Key_Home:
      return moveCursor(0);
    case Qt::Key_End:
      return moveCursor(count() - 1);
    case Qt::Key_Return:
    case Qt::Key_Enter:
    case Qt::Key_Space:
      return choose(cursor_);
    default:
      QWidget::keyPressEvent(event);
  }
}

void StageRail::moveCursor(int index) {
  cursor_ = index;
  sayWhereTheFocusIs();
  update();
}

// A reader of the screen hears the cell as the widget's description.
void StageRail::sayWhereTheFocusIs() {
  if (count() == 0) return;
  const StageStatus& stage = stages_[cursor_];
  const QString words = stateText(stage);
  setAccessibleDescription(titleOf(stage, cursor_) + (words.isEmpty() ? words : ", " + words));
}

void StageRail::focusInEvent(QFocusEvent* event) {
  if (event->reason() != Qt::MouseFocusReason) {
    if (const int i = indexOf(selected_); i >= 0) moveCursor(i);
  }
  QWidget::focusInEvent(event);
}

void StageRail::leaveEvent(QEvent*) {
  hovered_ = -1;
  update();
}

void StageRail::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) updateGeometry();
}

bool StageRail::event(QEvent* event) {
  if (event->type() == QEvent::ToolTip) {
    auto* help = static_cast<QHelpEvent*>(event);
    const int i = cellAt(help->pos());
    QToolTip::showText(help->globalPos(), i < 0 ? QString() : tip(i), this);
    return true;
  }
  return QWidget::event(event);
}

}  // namespace beam
