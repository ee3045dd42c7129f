// SPDX-License-Identifier: Apache-2.0
#include "core/io/written_by.h"

#include <fmt/format.h>

#include <fstream>

namespace beam {
namespace {

// Within it stands what every format of ours says first; EXR lists its channels before.
constexpr std::size_t kBeginning = 16384;

}  // namespace

std::string writerOf(std::string_view command) { return fmt::format("BEAM Studio, beam {}", command); }

bool isWrittenBy(const std::filesystem::path& file, std::string_view command) {
  std::error_code out_of_reach;
  if (!std::filesystem::is_regular_file(file, out_of_reach)) return false;
  std::ifstream in(file, std::ios::binary);
  std::string beginning(kBeginning, '\0');
  in.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(in.gcount()));
  return beginning.find(writerOf(command)) != std::string::npos;
}

std::string noteIn(const FileNotes& notes, std::string_view name) {
  for (const auto& [known, text] : notes) {
    if (known == name) return text;
  }
  return {};
}

}  // namespace beam
