// SPDX-License-Identifier: Apache-2.0
// A time as a person says it.
#pragma once

#include <string>

namespace beam {

// "1 h 05 min", "3 min 20 s", "12 s".
std::string durationText(double seconds);

}  // namespace beam
