// SPDX-License-Identifier: Apache-2.0
// The log as the console and the file see it, newest at the bottom; warnings and errors stand out.
#pragma once

#include <QPlainTextEdit>
#include <QTimer>

#include <mutex>
#include <vector>

#include "core/base/log.h"

namespace beam {

class LogPanel final : public QPlainTextEdit {
  Q_OBJECT

 public:
  explicit LogPanel(QWidget* parent = nullptr);
  ~LogPanel() override;
  void add(LogLevel level, const QString& text);

 private:
  void drain();

  std::mutex mutex_;
  std::vector<LogRecord> waiting_;  // from any thread
  QTimer timer_;
  int sink_ = 0;
};

}  // namespace beam
