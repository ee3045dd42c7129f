// SPDX-License-Identifier: Apache-2.0
// Log records to sinks. Warnings and errors are facts for the user: they name file, camera or frame, what was
// expected, what was found, what to do. Repeated warnings are batched by the sink that shows them.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>

namespace beam {

enum class LogLevel { Debug, Info, Warning, Error };

struct LogRecord {
  LogLevel level;
  std::string text;
};

using LogSink = std::function<void(const LogRecord&)>;

// Adds a sink (called under a lock, from any thread); the returned token removes it again.
int addLogSink(LogSink sink);
void removeLogSink(int token);

void writeLog(LogLevel level, const std::string& text);

template <class... A>
void logDebug(fmt::format_string<A...> f, A&&... a) {
  writeLog(LogLevel::Debug, fmt::format(f, std::forward<A>(a)...));
}
template <class... A>
void logInfo(fmt::format_string<A...> f, A&&... a) {
  writeLog(LogLevel::Info, fmt::format(f, std::forward<A>(a)...));
}
template <class... A>
void logWarning(fmt::format_string<A...> f, A&&... a) {
  writeLog(LogLevel::Warning, fmt::format(f, std::forward<A>(a)...));
}

}  // namespace beam
