// SPDX-License-Identifier: Apache-2.0
// A message over the views: what happened, to which file, what to do. Stays until it is dismissed or
// replaced.
#pragma once

#include <QFrame>

class QLabel;

namespace beam {

class MessagePanel final : public QFrame {
  Q_OBJECT

 public:
  enum class Kind { Error, Notice };
  explicit MessagePanel(QWidget* parent = nullptr);
  void show(Kind kind, const QString& title, const QString& text);
  QString title() const;
  QString text() const;

 private:
  QLabel* title_;
  QLabel* text_;
};

}  // namespace beam
