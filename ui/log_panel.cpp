// SPDX-License-Identifier: Apache-2.0
#include "ui/log_panel.h"

#include <QScrollBar>
#include <QTextBlock>
#include <QTime>

#include "ui/theme.h"
#include "ui/words.h"

namespace beam {
namespace {

constexpr int kDrain_ms = 100, kMostLines = 5000;

QColor colorOf(LogLevel level) {
  switch (level) {
    case LogLevel::Debug:
      return colors().quiet;
    case LogLevel::Info:
      break;
    case LogLevel::Warning:
      return colors().warning;
    case LogLevel::Error:
      return colors().failed;
  }
  return colors().text;
}

const char* wordOf(LogLevel level) {
  return level == LogLevel::Warning ? "warning: " : level == LogLevel::Error ? "error: " : "";
}

}  // namespace

LogPanel::LogPanel(QWidget* parent) : QPlainTextEdit(parent) {
  setObjectName("log");
  setReadOnly(true);
  setTabChangesFocus(true);
  setMaximumBlockCount(kMostLines);
  setPlaceholderText("What happens is written here.");
  setAccessibleName("Log");
  connect(verticalScrollBar(), &QScrollBar::actionTriggered, this,
          [this] { follows_ = verticalScrollBar()->sliderPosition() >= verticalScrollBar()->maximum(); });
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
  drain();
  append(level, text);
}

void LogPanel::append(LogLevel level, const QString& told) {
  const QString text = withStepTitles(stages_, told);
  const bool again = times_ > 0 && level == last_level_ && text == last_text_;
  times_ = again ? times_ + 1 : 1;
  last_level_ = level;
  last_text_ = text;
  const int before = verticalScrollBar()->value();
  if (again) {
    QTextCursor last(document()->lastBlock());
    last.movePosition(QTextCursor::EndOfBlock, QTextCursor::KeepAnchor);
    last.removeSelectedText();
    last.deletePreviousChar();
  }
  QString line = text.toHtmlEscaped().replace('\n', "<br>");
  if (times_ > 1) line += QString(" <b>×%1</b>").arg(times_);
  appendHtml(QString("<span style='color:%1'>%2</span> <span style='color:%3'>%4%5</span>")
                 .arg(colors().quiet.name(), QTime::currentTime().toString("hh:mm:ss"), colorOf(level).name(),
                      wordOf(level), line));
  if (follows_) {
    follow();
  } else {
    verticalScrollBar()->setValue(before);
  }
}

void LogPanel::follow() { verticalScrollBar()->setValue(verticalScrollBar()->maximum()); }

// A hidden tab has no size to scroll by.
void LogPanel::showEvent(QShowEvent* event) {
  QPlainTextEdit::showEvent(event);
  if (follows_) follow();
}

void LogPanel::resizeEvent(QResizeEvent* event) {
  QPlainTextEdit::resizeEvent(event);
  if (follows_) follow();
}

void LogPanel::drain() {
  std::vector<LogRecord> records;
  {
    std::lock_guard lock(mutex_);
    records.swap(waiting_);
  }
  for (const LogRecord& record : records) {
    const QString text = QString::fromStdString(record.text);
    append(record.level, text);
    if (record.level == LogLevel::Warning) Q_EMIT warned(text);
  }
}

}  // namespace beam
