// SPDX-License-Identifier: Apache-2.0
// Names of cameras as people choose them.
#pragma once

#include <fnmatch.h>

#include <string>

namespace beam {

// The name itself, or a pattern as shells have them: "cam0*", "cam?[13]". Case counts.
inline bool matchesName(const std::string& pattern, const std::string& name) {
  return pattern == name || fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

inline bool isPattern(const std::string& word) { return word.find_first_of("*?[") != std::string::npos; }

}  // namespace beam
