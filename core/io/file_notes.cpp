// SPDX-License-Identifier: Apache-2.0
#include "core/io/file_notes.h"

#include <cstdint>
#include <fstream>
#include <sstream>

#include "core/base/error.h"
#include "core/io/content_seal.h"
#include "core/io/exr_header.h"
#include "core/io/file.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<std::byte>;

constexpr std::uint64_t kMaxFile = 1ull << 31;

std::uint32_t bigEndian(const Bytes& b, std::size_t i) {
  std::uint32_t v = 0;
  for (std::size_t k = 0; k < 4; ++k) v = v << 8 | std::to_integer<std::uint32_t>(b[i + k]);
  return v;
}

// Chunks: length, type, data, checksum (PNG specification 5.3). Up to the first of pixels.
FileNotes pngNotes(const Bytes& b) {
  FileNotes notes;
  for (std::size_t i = 8; b.size() - i >= 12;) {
    const std::uint64_t length = bigEndian(b, i);
    if (length > b.size() - i - 12) return notes;
    const std::string_view type(reinterpret_cast<const char*>(b.data()) + i + 4, 4);
    const std::string_view data(type.data() + 4, length);
    const std::size_t end = data.find('\0');
    if (type == "IDAT") return notes;
    if (type == "tEXt" && end != std::string_view::npos)
      notes.emplace_back(data.substr(0, end), data.substr(end + 1));
    i += length + 12;
  }
  return notes;
}

FileNotes plyNotes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  FileNotes notes;
  for (std::string line; std::getline(in, line) && line != "end_header";) {
    std::istringstream words(line);
    std::string word, name;
    if (words >> word >> name && word == "comment" && words.get() == ' ') {
      std::getline(words, word);
      notes.emplace_back(name, word);
    }
  }
  return notes;
}

bool begins(const fs::path& file, std::string_view magic) {
  std::ifstream in(file, std::ios::binary);
  std::string found(magic.size(), '\0');
  in.read(found.data(), static_cast<std::streamsize>(found.size()));
  return in && found == magic;
}

}  // namespace

FileNotes notesIn(const fs::path& file) {
  std::error_code failed;
  if (!fs::is_regular_file(file, failed) || !isSealed(file)) return {};
  try {
    if (begins(file, "ply\n")) return plyNotes(file);
    if (begins(file, "\x89PNG\r\n\x1a\n")) return pngNotes(readFile(file, kMaxFile));
    if (begins(file, "\x76\x2f\x31\x01")) return exrNotes(readFile(file, kMaxFile), file);
  } catch (const Error&) {
    return {};  // it cannot be read or is damaged
  }
  return {};
}

}  // namespace beam
