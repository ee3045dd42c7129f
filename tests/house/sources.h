// SPDX-License-Identifier: Apache-2.0
// The sources of the house as texts, for laws over all of them.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace beam::testing {

struct Source {
  std::string path;  // relative to the root
  std::vector<std::string> lines;
};

inline Source sourceAt(const std::filesystem::path& file) {
  const std::filesystem::path root = BEAM_SOURCE_DIR;
  Source source{std::filesystem::relative(file, root).string(), {}};
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) source.lines.push_back(line);
  return source;
}

// Headers and sources below these folders of the root; one that is not there has none.
inline std::vector<Source> sourcesIn(const std::vector<std::string>& folders) {
  const std::filesystem::path root = BEAM_SOURCE_DIR;
  std::vector<Source> found;
  for (const std::string& folder : folders) {
    if (!std::filesystem::exists(root / folder)) continue;
    for (const auto& e : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string extension = e.path().extension().string();
      if (extension == ".h" || extension == ".cpp") found.push_back(sourceAt(e.path()));
    }
  }
  return found;
}

}  // namespace beam::testing
