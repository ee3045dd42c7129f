// SPDX-License-Identifier: Apache-2.0
// A folder of its own for a test, gone with it; and where the shared data lies, if it does.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace beam::testing {

class TempDir {
 public:
  TempDir() {
    std::string pattern = (std::filesystem::temp_directory_path() / "beam-test-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~TempDir() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// BEAM_SHARED, else ../shared beside the source tree; nothing when it is not there.
inline std::optional<std::filesystem::path> sharedFolder() {
  const char* set = std::getenv("BEAM_SHARED");
  const std::filesystem::path folder =
      set ? std::filesystem::path(set) : std::filesystem::path(BEAM_SOURCE_DIR) / "../shared";
  if (std::filesystem::exists(folder / "data")) return folder;
  return std::nullopt;
}

}  // namespace beam::testing
