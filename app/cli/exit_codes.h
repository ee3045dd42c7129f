// SPDX-License-Identifier: Apache-2.0
// What the program ends with. Failures have the codes of core/base/error.h; the rest is here.
#pragma once

#include <vector>

namespace beam {

inline constexpr int kDone = 0, kSomeFailed = 10, kInterrupted = 75;

struct ExitCodeInfo {
  int code = 0;
  const char* meaning;  // what is true then
  const char* advice;   // what to do; may be empty
};

// Every code, ascending.
const std::vector<ExitCodeInfo>& exitCodes();

}  // namespace beam
