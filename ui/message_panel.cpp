// SPDX-License-Identifier: Apache-2.0
#include "ui/message_panel.h"

#include <QAction>
#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QScrollArea>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>
#include <QVariant>

#include <algorithm>

namespace beam {
namespace {

constexpr double kMostShare = 0.22;  // of the window's height

}  // namespace

MessagePanel::MessagePanel(QWidget* parent)
    : QFrame(parent),
      title_(new QLabel),
      text_(new QLabel),
      scroll_(new QScrollArea),
      remedy_(new QToolButton) {
  setObjectName("message");
  title_->setStyleSheet("font-weight: 600");
  title_->setWordWrap(true);
  text_->setWordWrap(true);
  text_->setTextFormat(Qt::PlainText);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  text_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  scroll_->setWidget(text_);
  scroll_->setWidgetResizable(true);
  scroll_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll_->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  auto* close = new QToolButton;
  close->setObjectName("flat");
  close->setText("✕");
  close->setToolTip("Dismiss");
  close->setAccessibleName("Dismiss the message");
  close->setFocusPolicy(Qt::TabFocus);
  connect(close, &QToolButton::clicked, this, &QWidget::hide);
  auto* column = new QVBoxLayout;
  column->setSpacing(3);
  column->addWidget(title_);
  column->addWidget(scroll_);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(10, 6, 6, 6);
  row->addLayout(column, 1);
  row->addWidget(remedy_, 0, Qt::AlignTop);
  row->addWidget(close, 0, Qt::AlignTop);
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  hide();
}

void MessagePanel::show(Kind kind, const QString& title, const QString& text, QAction* remedy) {
  setProperty("kind", QString(kind == Kind::Notice ? "notice" : "error"));
  for (QWidget* part :
       {static_cast<QWidget*>(this), static_cast<QWidget*>(title_), static_cast<QWidget*>(text_)}) {
    part->style()->unpolish(part);
    part->style()->polish(part);
  }
  title_->setText(title);
  text_->setText(text);
  scroll_->setVisible(!text.isEmpty());
  if (QAction* before = remedy_->defaultAction()) remedy_->removeAction(before);
  if (remedy) remedy_->setDefaultAction(remedy);
  remedy_->setVisible(remedy != nullptr);
  setVisible(true);
  fitHeight();
}

// As high as the text at this width, and never more than a share of the window.
void MessagePanel::fitHeight() {
  const int title = title_->heightForWidth(std::max(1, title_->width()));
  const int most =
      std::max(2 * fontMetrics().height(), static_cast<int>(kMostShare * window()->height()) - title - 24);
  const int text = text_->heightForWidth(std::max(1, scroll_->width() - 12));
  scroll_->setFixedHeight(std::clamp(text + 2, fontMetrics().height(), most));
}

void MessagePanel::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  fitHeight();
}

void MessagePanel::showEvent(QShowEvent* event) {
  QFrame::showEvent(event);
  window()->installEventFilter(this);
  fitHeight();
}

bool MessagePanel::eventFilter(QObject* watched, QEvent* event) {
  if (watched == window() && event->type() == QEvent::Resize && isVisible()) fitHeight();
  return QFrame::eventFilter(watched, event);
}

QString MessagePanel::title() const { return title_->text(); }
QString MessagePanel::text() const { return text_->text(); }

}  // namespace beam
