// SPDX-License-Identifier: Apache-2.0
// The log as the console and the file see it, newest at the bottom and in view unless a person scrolled up;
// warnings and errors stand out, and what is told again at once stands once, with how often.
#pragma once

#include <QPlainTextEdit>
#include <QTimer>

#include <mutex>
#include <vector>

#include "core/base/log.h"
#include "core/pipeline/stage_registry.h"

namespace beam {

class LogPanel final : public QPlainTextEdit {
  Q_OBJECT

 public:
  explicit LogPanel(QWidget* parent = nullptr);
  ~LogPanel() override;
  // After what was logged before it.
  void add(LogLevel level, const QString& text);
  // Whose titles stand for the ids in what is logged.
  void setStages(const std::vector<StageInfo>& stages) { stages_ = stages; }

 Q_SIGNALS:
  void warned(const QString& text);  // by the program's own log, from any thread

 protected:
  void showEvent(QShowEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  void drain();
  void append(LogLevel level, const QString& told);
  void follow();

  std::vector<StageInfo> stages_;
  std::mutex mutex_;
  std::vector<LogRecord> waiting_;  // from any thread
  QTimer timer_;
  int sink_ = 0;
  LogLevel last_level_ = LogLevel::Debug;
  QString last_text_;
  int times_ = 0;        // that the last line was told
  bool follows_ = true;  // a person who scrolled up reads there
};

}  // namespace beam
