// SPDX-License-Identifier: Apache-2.0
#include "ui/message_panel.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>
#include <QVariant>

namespace beam {

MessagePanel::MessagePanel(QWidget* parent) : QFrame(parent), title_(new QLabel), text_(new QLabel) {
  setObjectName("message");
  title_->setStyleSheet("font-weight: 600");
  text_->setWordWrap(true);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* close = new QToolButton;
  close->setObjectName("flat");
  close->setText("✕");
  close->setToolTip("Dismiss");
  connect(close, &QToolButton::clicked, this, &QWidget::hide);
  auto* column = new QVBoxLayout;
  column->setSpacing(3);
  column->addWidget(title_);
  column->addWidget(text_);
  auto* row = new QHBoxLayout(this);
  row->addLayout(column, 1);
  row->addWidget(close, 0, Qt::AlignTop);
  hide();
}

void MessagePanel::show(Kind kind, const QString& title, const QString& text) {
  setProperty("kind", QString(kind == Kind::Notice ? "notice" : "error"));
  for (QWidget* part :
       {static_cast<QWidget*>(this), static_cast<QWidget*>(title_), static_cast<QWidget*>(text_)}) {
    part->style()->unpolish(part);
    part->style()->polish(part);
  }
  title_->setText(title);
  text_->setText(text);
  setVisible(true);
}

QString MessagePanel::title() const { return title_->text(); }
QString MessagePanel::text() const { return text_->text(); }

}  // namespace beam
