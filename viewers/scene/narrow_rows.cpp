// SPDX-License-Identifier: Apache-2.0
#include "viewers/scene/narrow_rows.h"

#include <QEvent>

#include <algorithm>

namespace beam {

WrappingRow::WrappingRow(int spacing_px) { setSpacing(spacing_px); }

WrappingRow::~WrappingRow() {
  for (QLayoutItem* item : items_) delete item;
}

void WrappingRow::addItem(QLayoutItem* item) { items_.push_back(item); }

QLayoutItem* WrappingRow::itemAt(int index) const {
  return index >= 0 && index < count() ? items_[index] : nullptr;
}

QLayoutItem* WrappingRow::takeAt(int index) {
  QLayoutItem* item = itemAt(index);
  if (item) items_.erase(items_.begin() + index);
  return item;
}

QSize WrappingRow::sizeHint() const {
  const QMargins around = contentsMargins();
  QSize size(around.left() + around.right() + spacing() * std::max(0, count() - 1), 0);
  for (const QLayoutItem* item : items_) {
    size.rwidth() += item->sizeHint().width();
    size.setHeight(std::max(size.height(), item->sizeHint().height()));
  }
  return size + QSize(0, around.top() + around.bottom());
}

QSize WrappingRow::minimumSize() const {
  QSize size;
  for (const QLayoutItem* item : items_) size = size.expandedTo(item->sizeHint());
  return size.grownBy(contentsMargins());
}

void WrappingRow::setGeometry(const QRect& area) {
  QLayout::setGeometry(area);
  arrange(area, true);
}

int WrappingRow::arrange(const QRect& area, bool place) const {
  const QRect inside = area.marginsRemoved(contentsMargins());
  QPoint at = inside.topLeft();
  int line_height = 0;
  for (QLayoutItem* item : items_) {
    const QSize size = item->sizeHint();
    if (at.x() > inside.left() && at.x() + size.width() > inside.left() + inside.width()) {
      at = {inside.left(), at.y() + line_height + spacing()};
      line_height = 0;
    }
    if (place) item->setGeometry({at, size});
    at.rx() += size.width() + spacing();
    line_height = std::max(line_height, size.height());
  }
  return at.y() + line_height + contentsMargins().bottom() - area.top();
}

ElidedLine::ElidedLine(QWidget* parent) : QLabel(parent) {
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);  // words must not widen the window
}

void ElidedLine::setWords(const QString& words) {
  words_ = words;
  fit();
}

void ElidedLine::resizeEvent(QResizeEvent* event) {
  QLabel::resizeEvent(event);
  fit();
}

void ElidedLine::changeEvent(QEvent* event) {
  QLabel::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) fit();
}

void ElidedLine::fit() {
  const QString shown = fontMetrics().elidedText(words_, Qt::ElideRight, contentsRect().width());
  if (shown != text()) setText(shown);
  setToolTip(shown == words_ ? QString() : words_);
}

}  // namespace beam
