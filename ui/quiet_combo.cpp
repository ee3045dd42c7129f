// SPDX-License-Identifier: Apache-2.0
#include "ui/quiet_combo.h"

#include <QKeyEvent>
#include <QStyleOptionComboBox>
#include <QStylePainter>
#include <QWheelEvent>

namespace beam {

QuietCombo::QuietCombo(QWidget* parent) : QComboBox(parent) {
  constexpr int kFewestLetters = 6;
  setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  setMinimumContentsLength(kFewestLetters);
  setFocusPolicy(Qt::StrongFocus);
  setMaxVisibleItems(30);
  connect(this, &QComboBox::currentTextChanged, this, &QuietCombo::tellWhatIsCut);
}

void QuietCombo::setHelp(const QString& help) {
  help_ = help;
  tellWhatIsCut();
}

// A closed box would search its list for what is typed; the open list still does.
void QuietCombo::keyPressEvent(QKeyEvent* event) {
  const QString text = event->text();
  const bool typed = !text.isEmpty() && text.front().isPrint() && event->key() != Qt::Key_Space;
  if (typed) return event->ignore();
  QComboBox::keyPressEvent(event);
}

void QuietCombo::wheelEvent(QWheelEvent* event) {
  if (!hasFocus()) return event->ignore();
  QComboBox::wheelEvent(event);
}

QString QuietCombo::shownText() const {
  QStyleOptionComboBox option;
  initStyleOption(&option);
  const QRect room =
      style()->subControlRect(QStyle::CC_ComboBox, &option, QStyle::SC_ComboBoxEditField, this);
  const QString text = currentIndex() < 0 ? placeholderText() : currentText();
  return fontMetrics().elidedText(text, Qt::ElideRight, room.width() - 2);
}

void QuietCombo::paintEvent(QPaintEvent*) {
  QStylePainter painter(this);
  QStyleOptionComboBox option;
  initStyleOption(&option);
  option.currentText = shownText();
  painter.drawComplexControl(QStyle::CC_ComboBox, option);
  painter.drawControl(QStyle::CE_ComboBoxLabel, option);
}

void QuietCombo::resizeEvent(QResizeEvent* event) {
  QComboBox::resizeEvent(event);
  tellWhatIsCut();
}

void QuietCombo::changeEvent(QEvent* event) {
  QComboBox::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) tellWhatIsCut();
}

void QuietCombo::tellWhatIsCut() {
  const QString text = currentText();
  const bool cut = shownText() != text && !text.isEmpty();
  QStringList parts;
  if (!help_.isEmpty()) parts << help_;
  if (cut) parts << text;
  setToolTip(parts.join("\n"));
}

}  // namespace beam
