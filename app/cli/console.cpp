// SPDX-License-Identifier: Apache-2.0
#include "app/cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "app/cli/terminal.h"
#include "core/base/duration_text.h"
#include "core/base/error.h"
#include "core/base/log.h"

namespace beam {
namespace {

constexpr auto kBarEvery = std::chrono::milliseconds(100);
constexpr auto kLineEvery = std::chrono::seconds(5);
constexpr std::size_t kBarWidth = 24, kLeastBarWidth = 8;

// File names of the user may hold escape sequences; a terminal must not obey them.
std::string harmless(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') c = '?';
    if (c == 0x7f) c = '?';
  }
  return text;
}

std::string rateText(double rate) {
  if (rate <= 0) return {};
  return rate < 10 ? fmt::format(", {:.1f}/s", rate) : fmt::format(", {:.0f}/s", rate);
}

std::string leftText(double seconds) {
  return seconds < 0 ? std::string() : fmt::format(", {} left", durationText(seconds));
}

std::string barText(double fraction, std::size_t width) {
  const auto full = static_cast<std::size_t>(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(width));
  return fmt::format("[{}{}]", std::string(full, '#'), std::string(width - full, '.'));
}

}  // namespace

Console::Console() {
  terminal_ = isDrawable(STDERR_FILENO);
  const char* no_color = std::getenv("NO_COLOR");
  if (!terminal_) last_shown_ = Clock::now();  // short work needs no lines
  color_ = terminal_ && (!no_color || !*no_color);
  sink_ = addLogSink([this](const LogRecord& record) {
    if (record.level == LogLevel::Warning) warning(record.text);
    if (record.level == LogLevel::Error) error(record.text);
    if (record.level == LogLevel::Info) detail(record.text);
  });
}

Console::~Console() {
  removeLogSink(sink_);
  endProgress();
}

void Console::setQuiet(bool quiet) { quiet_ = quiet; }
void Console::setVerbose(bool verbose) { verbose_ = verbose; }

// The work goes on: what it comes to matters more than what is told of it.
void Console::put(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stderr) != text.size()) said_all_ = false;
}

void Console::clearBar() {
  if (!bar_shown_) return;
  put("\r\033[K");
  bar_shown_ = false;
}

void Console::line(const char* mark, const char* color, const std::string& text) {
  clearBar();
  std::string whole = fmt::format("{}{}", mark, harmless(text));
  if (terminal_) whole = foldedToColumns(whole, static_cast<std::size_t>(columnsOf(STDERR_FILENO)));
  if (color_ && *color) {
    const std::size_t length = std::char_traits<char>::length(mark) - 1;  // without the blank after it
    whole = fmt::format("\033[{}m{}\033[0m{}", color, whole.substr(0, length), whole.substr(length));
  }
  put(whole + "\n");
}

void Console::print(const std::string& text) {
  std::lock_guard lock(mutex_);
  clearBar();
  const std::string whole = harmless(text) + "\n";
  if (std::fwrite(whole.data(), 1, whole.size(), stdout) == whole.size() && std::fflush(stdout) == 0) return;
  throw Error(Error::Kind::Storage, fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

void Console::tell(const std::string& words) {
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  print(terminal ? foldedToColumns(words, static_cast<std::size_t>(columnsOf(STDOUT_FILENO))) : words);
}

void Console::info(const std::string& text) {
  std::lock_guard lock(mutex_);
  if (!quiet_) line("", "", text);
}

void Console::detail(const std::string& text) {
  if (verbose_) info(text);
}

void Console::warning(const std::string& text) {
  std::lock_guard lock(mutex_);
  if (warned_[text]++ == 0) line("warning: ", "33", text);
}

void Console::error(const std::string& text) {
  std::lock_guard lock(mutex_);
  line("error: ", "31", text);
}

// What fits: the bar first becomes shorter and goes, then the rate, then the end of the label.
std::string Console::barOf(const ConsoleProgress& p) const {
  const auto width = static_cast<std::size_t>(columnsOf(STDERR_FILENO)) - 1;  // the last column may wrap
  const std::string percent = fmt::format("{:3.0f} % ", p.fraction * 100), label = harmless(p.label);
  const std::string left = leftText(p.seconds_left), tail = rateText(p.rate) + left;
  const std::size_t full = columnsOf(percent + label + tail);
  if (full + kLeastBarWidth + 3 <= width) {
    const std::size_t bar = std::min(kBarWidth, width - full - 3);
    return fmt::format("{} {}{}{}", barText(p.fraction, bar), percent, label, tail);
  }
  const std::string& end = full <= width ? tail : left;
  const std::size_t taken = columnsOf(percent + end), least = std::min<std::size_t>(12, columnsOf(label));
  if (taken + least > width) return cutToColumns(percent + label, width);
  return percent + cutToColumns(label, width - taken) + end;
}

void Console::progress(const ConsoleProgress& p) {
  std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (quiet_) return;
  if (now - last_shown_ < (terminal_ ? Clock::duration(kBarEvery) : kLineEvery)) return;
  last_shown_ = now;
  if (!terminal_) {
    return line("", "",
                fmt::format("{:3.0f} % {}{}{}", p.fraction * 100, p.label, rateText(p.rate),
                            leftText(p.seconds_left)));
  }
  put(fmt::format("\r{}\033[K", barOf(p)));
  std::fflush(stderr);
  bar_shown_ = true;
}

void Console::endProgress() {
  std::lock_guard lock(mutex_);
  clearBar();
  if (terminal_) last_shown_ = {};
}

Progress::Listener Console::listener() {
  struct Meter {
    Clock::time_point start = Clock::now(), part_start = start;
    std::string part;
  };
  return [this, meter = std::make_shared<Meter>()](const ProgressReport& report) {
    const auto now = Clock::now();
    if (report.label != meter->part || report.done == 0) meter->part = report.label, meter->part_start = now;
    const double total = std::chrono::duration<double>(now - meter->start).count();
    const double inside = std::chrono::duration<double>(now - meter->part_start).count();
    ConsoleProgress p{report.fraction, report.label};
    if (inside > 0.5) p.rate = static_cast<double>(report.done) / inside;
    if (report.fraction > 0.02 && total > 1) p.seconds_left = total * (1 - report.fraction) / report.fraction;
    progress(p);
  };
}

}  // namespace beam
