// SPDX-License-Identifier: Apache-2.0
#include "ui/wrapped_note.h"

#include <QEvent>
#include <QTextLayout>

namespace beam {

WrappedNote::WrappedNote(int lines, QWidget* parent) : QLabel(parent), lines_(lines) {
  setWordWrap(false);  // lines are broken here: a label that wraps has no constant height
  setTextFormat(Qt::PlainText);
  setAlignment(Qt::AlignLeft | Qt::AlignTop);
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
}

void WrappedNote::setWords(const QString& words) {
  words_ = words;
  lay();
}

QSize WrappedNote::minimumSizeHint() const {
  const QMargins margins = contentsMargins();
  return {0, lines_ * fontMetrics().lineSpacing() + margins.top() + margins.bottom() + 2 * margin() + 2};
}

QSize WrappedNote::sizeHint() const { return minimumSizeHint(); }

QString WrappedNote::fitting() const {
  const int width = contentsRect().width();
  QTextLayout layout(words_, font());
  QStringList found;
  layout.beginLayout();
  for (QTextLine line = layout.createLine(); line.isValid(); line = layout.createLine()) {
    line.setLineWidth(width);
    if (found.size() + 1 == lines_) {
      found << fontMetrics().elidedText(words_.mid(line.textStart()), Qt::ElideRight, width);
      break;
    }
    found << words_.mid(line.textStart(), line.textLength()).trimmed();
  }
  layout.endLayout();
  return found.join('\n');
}

void WrappedNote::lay() {
  const QString shown = fitting();
  setText(shown);
  setToolTip(shown.contains("…") ? words_ : QString());
}

void WrappedNote::resizeEvent(QResizeEvent* event) {
  QLabel::resizeEvent(event);
  lay();
}

void WrappedNote::changeEvent(QEvent* event) {
  QLabel::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) lay();
}

}  // namespace beam
