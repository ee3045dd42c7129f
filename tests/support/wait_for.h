// SPDX-License-Identifier: Apache-2.0
// Waiting for what the event loop brings.
#pragma once

#include <QApplication>
#include <QDeadlineTimer>

namespace beam::testing {

// Whether the condition came true; `patience_ms` is there to end a test that hangs.
template <class Condition>
bool waitFor(Condition&& condition, int patience_ms = 20000) {
  for (QDeadlineTimer deadline(patience_ms); !deadline.hasExpired();) {
    QApplication::processEvents(QEventLoop::AllEvents, 20);
    if (condition()) return true;
  }
  return false;
}

}  // namespace beam::testing
