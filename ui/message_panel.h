// SPDX-License-Identifier: Apache-2.0
// A message over the views: what happened, to which file, what to do. Stays until it is dismissed or
// replaced. Long texts scroll: the views keep their room.
#pragma once

#include <QFrame>

class QAction;
class QLabel;
class QScrollArea;
class QToolButton;

namespace beam {

class MessagePanel final : public QFrame {
  Q_OBJECT

 public:
  enum class Kind { Error, Notice };
  explicit MessagePanel(QWidget* parent = nullptr);
  // `remedy`: a command that helps, as a button beside the words; null: there is none.
  void show(Kind kind, const QString& title, const QString& text, QAction* remedy = nullptr);
  QString title() const;
  QString text() const;

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void fitHeight();

  QLabel* title_;
  QLabel* text_;
  QScrollArea* scroll_;
  QToolButton* remedy_;
};

}  // namespace beam
