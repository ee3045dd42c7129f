// SPDX-License-Identifier: Apache-2.0
#include "app/cli/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <ctime>

#include "app/cli/exit_codes.h"

namespace beam {
namespace {

sigset_t handledSignals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  struct sigaction hangup {};
  ::sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaddset(&set, SIGHUP);  // nohup wants the work to go on
  return set;
}

}  // namespace

Interrupt::Interrupt() {
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is a storage error with a message, not a death
  const sigset_t set = handledSignals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  thread_ = std::jthread([this, set](const std::stop_token& ended) {
    const timespec patience{0, 50'000'000};
    while (!ended.stop_requested()) {
      const int number = sigtimedwait(&set, nullptr, &patience);
      if (number < 0) continue;
      // The second time the user does not want to wait; what is published is safe. A terminal that goes may
      // tell more than once.
      if (!source_.request_stop() && number != SIGHUP) ::_exit(kInterrupted);
    }
  });
}

Interrupt::~Interrupt() = default;

}  // namespace beam
