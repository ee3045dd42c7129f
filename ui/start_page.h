// SPDX-License-Identifier: Apache-2.0
// What one sees before anything is open: three ways in, the recent ones, and what this machine is.
#pragma once

#include <QStringList>
#include <QWidget>

class QVBoxLayout;

namespace beam {

class StartPage final : public QWidget {
  Q_OBJECT

 public:
  StartPage(bool has_sample, const QString& machine, QWidget* parent = nullptr);
  void setRecent(const QStringList& folders);

 Q_SIGNALS:
  void openCaptureWanted();
  void openProjectWanted();
  void sampleWanted();
  void recentChosen(const QString& folder);

 private:
  QVBoxLayout* recent_;
};

}  // namespace beam
