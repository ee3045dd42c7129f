// SPDX-License-Identifier: Apache-2.0
#include "ui/elided_label.h"

#include <QEvent>
#include <QPainter>
#include <QStyle>

namespace beam {

ElidedLabel::ElidedLabel(const QString& text, QWidget* parent) : QLabel(parent), whole_(text) {
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  showTip();
}

void ElidedLabel::setText(const QString& text) {
  if (text == whole_) return;
  whole_ = text;
  setAccessibleName(text);
  // Words that take what room there is ask for no new layout, thirty times a second.
  if (sizePolicy().horizontalPolicy() != QSizePolicy::Ignored) updateGeometry();
  showTip();
  update();
}

void ElidedLabel::setNote(const QString& note) {
  note_ = note;
  showTip();
}

void ElidedLabel::setElideMode(Qt::TextElideMode mode) {
  mode_ = mode;
  showTip();
  update();
}

void ElidedLabel::setLeastLetters(int letters) {
  letters_ = letters;
  updateGeometry();
}

QString ElidedLabel::shownText() const {
  return fontMetrics().elidedText(whole_, mode_, contentsRect().width());
}

QSize ElidedLabel::sizeHint() const {
  const QMargins around = contentsMargins();
  // A pixel more than the words: rounding must not elide what fits.
  return {fontMetrics().horizontalAdvance(whole_) + around.left() + around.right() + 2,
          fontMetrics().height() + around.top() + around.bottom()};
}

QSize ElidedLabel::minimumSizeHint() const {
  return {letters_ * fontMetrics().averageCharWidth(), sizeHint().height()};
}

void ElidedLabel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  style()->drawItemText(&painter, contentsRect(), static_cast<int>(alignment()), palette(), isEnabled(),
                        shownText(), foregroundRole());
}

void ElidedLabel::resizeEvent(QResizeEvent* event) {
  QLabel::resizeEvent(event);
  showTip();
}

void ElidedLabel::changeEvent(QEvent* event) {
  QLabel::changeEvent(event);
  if (event->type() != QEvent::FontChange && event->type() != QEvent::StyleChange) return;
  updateGeometry();
  showTip();
}

void ElidedLabel::showTip() {
  QStringList lines;
  if (shownText() != whole_) lines << whole_;
  if (!note_.isEmpty()) lines << note_;
  setToolTip(lines.join("\n"));
}

}  // namespace beam
