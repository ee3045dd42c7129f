// SPDX-License-Identifier: Apache-2.0
// What the program says: results on standard output, `warning:` and `error:` lines and progress on standard
// error. On a terminal no line of standard error is longer than the terminal is wide at that moment.
#pragma once

#include <atomic>
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

  // --quiet: no progress and no info lines; warnings and errors stay. --verbose: details as well.
  void setQuiet(bool quiet);
  void setVerbose(bool verbose);
  bool verbose() const { return verbose_; }

  // Standard output: what was asked for, also when quiet. Throws Error{Storage} when it does not take it.
  void print(const std::string& text);
  // Likewise, words for a person: on a terminal they are folded at its width.
  void tell(const std::string& words);
  void info(const std::string& line);     // standard error: what is going on
  void detail(const std::string& line);   // info that is told with --verbose alone
  void warning(const std::string& text);  // "warning: ..."; a text is shown once
  void error(const std::string& text);    // "error: ..."
  // Whether standard error took all of it.
  bool saidAll() const { return said_all_; }

  // A bar on a terminal, otherwise a plain line every few seconds.
  void progress(const ConsoleProgress& progress);
  void endProgress();
  // For commands with a Progress of their own: Progress root(context.stop, console.listener()).
  Progress::Listener listener();

 private:
  using Clock = std::chrono::steady_clock;
  void put(const std::string& text);  // on standard error
  void clearBar();
  // `mark` is coloured and counts into the width.
  void line(const char* mark, const char* color, const std::string& text);
  std::string barOf(const ConsoleProgress& progress) const;

  std::mutex mutex_;
  bool quiet_ = false, verbose_ = false;
  bool terminal_ = false, color_ = false;
  bool bar_shown_ = false;
  std::atomic<bool> said_all_ = true;
  Clock::time_point last_shown_{};
  std::map<std::string, int> warned_;
  int sink_ = 0;
};

}  // namespace beam
