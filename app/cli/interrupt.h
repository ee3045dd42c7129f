// SPDX-License-Identifier: Apache-2.0
// SIGINT and SIGTERM as a stop token. Make one before any thread starts: signals are then taken by its thread
// alone.
#pragma once

#include <stop_token>
#include <thread>

namespace beam {

class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::jthread thread_;
};

}  // namespace beam
