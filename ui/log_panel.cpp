// SPDX-License-Identifier: Apache-2.0
#include "ui/log_panel.h"

#include <QTime>

namespace beam {
namespace {

constexpr int kDrain_ms = 100, kMostLines = 5000;

const char* colorOf(LogLevel level) {
  switch (level) {
    case LogLevel::Debug:
      return "#757b84";
    case LogLevel::Info:
      return "#c3c8cf";
    case LogLevel::Warning:
      return "#e0b35c";
    case LogLevel::Error:
      return "#ee8d83";
  }
  return "#c3c8cf";
}

const char* wordOf(LogLevel level) {
  return level == LogLevel::Warning ? "warning: " : level == LogLevel::Error ? "error: " : "";
}

}  // namespace

LogPanel::LogPanel(QWidget* parent) : QPlainTextEdit(parent) {
  setReadOnly(true);
  setMaximumBlockCount(kMostLines);
  setPlaceholderText("What happens is written here.");
  sink_ = addLogSink([this](const LogRecord& record) {
    if (record.level == LogLevel::Debug) return;
    std::lock_guard lock(mutex_);
    waiting_.push_back(record);
  });
  timer_.setInterval(kDrain_ms);
  connect(&timer_, &QTimer::timeout, this, &LogPanel::drain);
  timer_.start();
}

LogPanel::~LogPanel() { removeLogSink(sink_); }

void LogPanel::add(LogLevel level, const QString& text) {
  appendHtml(QString("<span style='color:#757b84'>%1</span> <span style='color:%2'>%3%4</span>")
                 .arg(QTime::currentTime().toString("hh:mm:ss"), colorOf(level), wordOf(level),
                      text.toHtmlEscaped()));
}

void LogPanel::drain() {
  std::vector<LogRecord> records;
  {
    std::lock_guard lock(mutex_);
    records.swap(waiting_);
  }
  for (const LogRecord& record : records) add(record.level, QString::fromStdString(record.text));
}

}  // namespace beam
