// SPDX-License-Identifier: Apache-2.0
#include "app/cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "core/base/duration_text.h"
#include "core/base/log.h"

namespace beam {
namespace {

constexpr auto kBarEvery = std::chrono::milliseconds(100);
constexpr auto kLineEvery = std::chrono::seconds(5);
constexpr int kBarWidth = 24;

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

std::string barText(double fraction) {
  const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * kBarWidth);
  return fmt::format("[{}{}]", std::string(full, '#'), std::string(kBarWidth - full, '.'));
}

}  // namespace

Console::Console() {
  terminal_ = ::isatty(STDERR_FILENO) != 0;
  const char* no_color = std::getenv("NO_COLOR");
  if (!terminal_) last_shown_ = Clock::now();  // short work needs no lines
  color_ = terminal_ && (!no_color || !*no_color);
  sink_ = addLogSink([this](const LogRecord& record) {
    if (record.level == LogLevel::Warning) warning(record.text);
    if (record.level == LogLevel::Error) error(record.text);
  });
}

Console::~Console() {
  removeLogSink(sink_);
  endProgress();
}

void Console::setQuiet(bool quiet) { quiet_ = quiet; }

void Console::clearBar() {
  if (!bar_shown_) return;
  std::fputs("\r\033[K", stderr);
  bar_shown_ = false;
}

void Console::line(const std::string& text) {
  clearBar();
  fmt::print(stderr, "{}\n", harmless(text));
}

void Console::print(const std::string& text) {
  std::lock_guard lock(mutex_);
  clearBar();
  fmt::print("{}\n", harmless(text));
  std::fflush(stdout);
}

void Console::info(const std::string& text) {
  std::lock_guard lock(mutex_);
  if (!quiet_) line(text);
}

void Console::warning(const std::string& text) {
  std::lock_guard lock(mutex_);
  if (warned_[text]++ > 0) return;
  clearBar();
  std::fputs(color_ ? "\033[33mwarning:\033[0m " : "warning: ", stderr);
  line(text);
}

void Console::error(const std::string& text) {
  std::lock_guard lock(mutex_);
  clearBar();
  std::fputs(color_ ? "\033[31merror:\033[0m " : "error: ", stderr);
  line(text);
}

void Console::progress(const ConsoleProgress& p) {
  std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (quiet_) return;
  if (now - last_shown_ < (terminal_ ? Clock::duration(kBarEvery) : kLineEvery)) return;
  last_shown_ = now;
  const std::string text =
      fmt::format("{:3.0f} % {}{}{}", p.fraction * 100, p.label, rateText(p.rate), leftText(p.seconds_left));
  if (!terminal_) return line(text);
  fmt::print(stderr, "\r{} {}\033[K", barText(p.fraction), harmless(text));
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
