// SPDX-License-Identifier: Apache-2.0
// What one sees before anything is open: three ways in, the recent ones, and what this machine is.
#pragma once

#include <QStringList>
#include <QWidget>

class QHBoxLayout;
class QPushButton;
class QVBoxLayout;

namespace beam {

class CommandTable;

class StartPage final : public QWidget {
  Q_OBJECT

 public:
  explicit StartPage(const QString& machine, QWidget* parent = nullptr);
  // The buttons are commands of the window; once.
  void bind(CommandTable& commands);
  void setRecent(const QStringList& folders);
  // Why nothing can be opened now; empty: it can.
  void setRefusal(const QString& why);

 Q_SIGNALS:
  void recentChosen(const QString& folder);

 private:
  QPushButton* recentButton(const QString& folder);

  QHBoxLayout* buttons_;
  QVBoxLayout* recent_;
  QString refusal_;
  QStringList folders_;
};

}  // namespace beam
