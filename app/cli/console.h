// SPDX-License-Identifier: Apache-2.0
// The terminal: results on standard output; `warning:` and `error:` lines and progress on standard error.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "core/base/progress.h"

namespace beam {

// How far something is; what a bar or a plain line shows.
struct ConsoleProgress {
  double fraction = 0;
  std::string label;
  double rate = 0;           // steps a second; 0: not known
  double seconds_left = -1;  // < 0: not known
};

// Safe to call from several threads.
class Console {
 public:
  Console();
  ~Console();  // takes its log sink away and the bar off the screen
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  void setQuiet(bool quiet);  // no progress and no info lines; warnings and errors stay

  void print(const std::string& line);    // standard output: what was asked for, also when quiet
  void info(const std::string& line);     // standard error: what is going on
  void warning(const std::string& text);  // "warning: ..."; a text is shown once
  void error(const std::string& text);    // "error: ..."

  // A bar on a terminal, otherwise a plain line every few seconds.
  void progress(const ConsoleProgress& progress);
  void endProgress();
  // For commands with a Progress of their own: Progress root(context.stop, console.listener()).
  Progress::Listener listener();

 private:
  using Clock = std::chrono::steady_clock;
  void clearBar();
  void line(const std::string& text);

  std::mutex mutex_;
  bool quiet_ = false;
  bool terminal_ = false, color_ = false;
  bool bar_shown_ = false;
  Clock::time_point last_shown_{};
  std::map<std::string, int> warned_;
  int sink_ = 0;
};

}  // namespace beam
