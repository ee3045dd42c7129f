// SPDX-License-Identifier: Apache-2.0
// While it lives programs are looked for in other folders.
#pragma once

#include <cstdlib>
#include <string>

namespace beam::testing {

class SearchPath {
 public:
  explicit SearchPath(const std::string& folders) { ::setenv("PATH", folders.c_str(), 1); }
  ~SearchPath() { ::setenv("PATH", before_.c_str(), 1); }
  SearchPath(const SearchPath&) = delete;
  SearchPath& operator=(const SearchPath&) = delete;

 private:
  std::string before_ = std::getenv("PATH");
};

}  // namespace beam::testing
