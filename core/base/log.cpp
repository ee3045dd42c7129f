// SPDX-License-Identifier: Apache-2.0
#include "core/base/log.h"

#include <map>
#include <mutex>

namespace beam {
namespace {

struct Sinks {
  std::mutex mutex;
  std::map<int, LogSink> byToken;
  int next = 1;
};

Sinks& sinks() {
  static Sinks s;
  return s;
}

}  // namespace

int addLogSink(LogSink sink) {
  std::lock_guard lock(sinks().mutex);
  const int token = sinks().next++;
  sinks().byToken[token] = std::move(sink);
  return token;
}

void removeLogSink(int token) {
  std::lock_guard lock(sinks().mutex);
  sinks().byToken.erase(token);
}

void writeLog(LogLevel level, const std::string& text) {
  std::lock_guard lock(sinks().mutex);
  for (const auto& [token, sink] : sinks().byToken) sink({level, text});
}

}  // namespace beam
