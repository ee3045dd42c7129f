// SPDX-License-Identifier: Apache-2.0
// Another program as a worker: its input and output as streams, what it says on standard error, and its end.
// For tools that are started and never linked: ffmpeg. No shell is between.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"

namespace beam {

// Full path of the program of that name in the folders of PATH; none: it is not installed. Relative folders
// of PATH are passed over: what lies where the user stands is nobody's program.
std::optional<std::string> installedProgram(const std::string& name);

// One thread writes and finishes, one, the same or another, reads; stop() and errorText() are for any.
// Whoever writes more than the system holds between two programs (64 KiB) to one that answers on the go must
// read in another thread meanwhile, or both wait for ever. Standard error is drained here and never holds it
// up.
//
// It has default signal handling, a process group of its own, so that Ctrl-C is left to us to answer, and no
// descriptor of ours but its three. With a `progress`, what waits for the program looks at it every 50 ms and
// throws Cancelled; the program then still runs, until stop().
class ChildProcess {
 public:
  enum class Output { Discarded, Kept };  // Kept: read() has it, and somebody must read

  // `words`: the program, a path or a name that is looked for as above, and its arguments. Throws
  // Error{Usage} where there is no such program, Error{Storage} where it cannot be started.
  explicit ChildProcess(const std::vector<std::string>& words, Output output = Output::Discarded);
  // stop(), where it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // All of it. False: it takes no more, because it ended or closed its input.
  bool write(std::span<const std::byte> bytes, const Progress* progress = nullptr);
  // Nothing more follows.
  void closeInput();
  // Waits for some bytes and gives how many came, at most bytes.size() > 0; 0: no more will. What it wrote
  // before its end is still read after it.
  std::size_t read(std::span<std::byte> bytes, const Progress* progress = nullptr);

  // Closes its input and waits for its end. Its exit code; of one that a signal ended 128 + the signal.
  // Output that is Kept is read to its end before, or in another thread meanwhile.
  int finish(const Progress* progress = nullptr);
  // Asks it and what it started to end, and after that long kills them; 0: kills at once. Returns when it is
  // gone; write() and read() of other threads then return too.
  void stop(std::chrono::milliseconds patience = std::chrono::seconds(2));

  // The last 64 KiB of what it said on standard error; all of it is there once finish() or stop() returned.
  std::string errorText() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beam
