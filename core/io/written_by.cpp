// SPDX-License-Identifier: Apache-2.0
#include "core/io/written_by.h"

#include <fmt/format.h>

#include <fstream>

#include "core/io/movie_file.h"

namespace beam {
namespace {

// Within it stands what every format of ours says first; EXR lists its channels before.
constexpr std::size_t kBeginning = 16384;

// Where a format says it: what the file begins with, and the words with what surrounds them.
struct Signature {
  std::string_view magic;
  std::string words;
};

std::vector<Signature> signaturesOf(const std::string& writer) {
  std::string exr_size(4, '\0');  // little-endian
  exr_size[0] = static_cast<char>(writer.size());
  return {{"\x89PNG\r\n\x1a\n", std::string("tEXtSoftware") + '\0' + writer},
          {"\x76\x2f\x31\x01", std::string("Software") + '\0' + "string" + '\0' + exr_size + writer},
          {"ply\n", "\ncomment Software " + writer + "\n"},
          {"<!DOCTYPE html>", "<meta name=\"generator\" content=\"" + writer + "\""},
          {"{\n \"written_by\": {\n", "\"program\": \"" + writer + "\""}};
}

}  // namespace

std::string writerOf(std::string_view command) { return fmt::format("BEAM Studio, beam {}", command); }

bool isWrittenBy(const std::filesystem::path& file, std::string_view command) {
  std::error_code out_of_reach;
  if (!std::filesystem::is_regular_file(file, out_of_reach)) return false;
  std::ifstream in(file, std::ios::binary);
  std::string beginning(kBeginning, '\0');
  in.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(in.gcount()));
  for (const auto& [magic, words] : signaturesOf(writerOf(command)))
    if (beginning.starts_with(magic)) return beginning.find(words) != std::string::npos;
  return noteIn(notesOfMovie(file), "Software") == writerOf(command);
}

std::string noteIn(const FileNotes& notes, std::string_view name) {
  for (const auto& [known, text] : notes) {
    if (known == name) return text;
  }
  return {};
}

}  // namespace beam
