// SPDX-License-Identifier: Apache-2.0
#include "core/io/file_notes.h"

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/base/error.h"
#include "core/io/exr_header.h"
#include "core/io/file.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<std::byte>;

constexpr std::uint64_t kMaxFile = 1ull << 31;
constexpr std::size_t kMaxPlyHeader = 64 << 10;

std::uint32_t bigEndian(const Bytes& b, std::size_t i) {
  std::uint32_t v = 0;
  for (std::size_t k = 0; k < 4; ++k) v = v << 8 | std::to_integer<std::uint32_t>(b[i + k]);
  return v;
}

// Chunks: length, type, data, checksum of type and data (PNG specification 5.3).
FileNotes pngNotes(const Bytes& b) {
  FileNotes notes;
  for (std::size_t i = 8; b.size() - i >= 12;) {
    const std::uint64_t length = bigEndian(b, i);
    if (length > b.size() - i - 12) return {};
    const auto* type = reinterpret_cast<const unsigned char*>(b.data() + i + 4);
    if (::crc32_z(0, type, length + 4) != bigEndian(b, i + 8 + length)) return {};
    const std::string_view data(reinterpret_cast<const char*>(type) + 4, length);
    i += length + 12;
    if (std::memcmp(type, "IEND", 4) == 0) return i == b.size() ? notes : FileNotes{};
    const std::size_t end = data.find('\0');
    if (std::memcmp(type, "tEXt", 4) == 0 && end != std::string_view::npos)
      notes.emplace_back(data.substr(0, end), data.substr(end + 1));
  }
  return {};
}

// Bytes of a row with these properties as meshes are written; 0: others.
std::uint64_t rowBytes(const std::string& property) {
  if (property.starts_with("float ")) return 4;
  return property.starts_with("list uchar int ") ? 1 + 3 * 4 : 0;
}

FileNotes plyNotes(const fs::path& file, std::uint64_t file_bytes) {
  std::ifstream in(file, std::ios::binary);
  FileNotes notes;
  std::uint64_t rows = 0, expected = 0;
  for (std::string line; std::getline(in, line) && expected <= kMaxPlyHeader + file_bytes;) {
    if (in.tellg() > static_cast<std::streamoff>(kMaxPlyHeader)) return {};
    std::istringstream words(line);
    std::string word, name;
    words >> word;
    if (word == "end_header")
      return file_bytes == static_cast<std::uint64_t>(in.tellg()) + expected ? notes : FileNotes{};
    if (word == "element" && !(words >> name >> rows)) return {};
    if (word == "format" && line != "format binary_little_endian 1.0") return {};
    if (word == "property") {
      const std::uint64_t bytes = rowBytes(line.substr(word.size() + 1));
      if (bytes == 0 || rows > file_bytes) return {};
      expected += rows * bytes;
    }
    if (word == "comment" && words >> name && words.get() == ' ') {
      std::getline(words, word);
      notes.emplace_back(name, word);
    }
  }
  return {};
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
  if (!fs::is_regular_file(file, failed)) return {};
  const std::uint64_t bytes = fs::file_size(file, failed);
  if (failed) return {};
  try {
    if (begins(file, "ply\n")) return plyNotes(file, bytes);
    if (begins(file, "\x89PNG\r\n\x1a\n")) return pngNotes(readFile(file, kMaxFile));
    if (begins(file, "\x76\x2f\x31\x01")) return exrNotes(readFile(file, kMaxFile), file);
  } catch (const Error&) {
    return {};  // it cannot be read or is damaged
  }
  return {};
}

}  // namespace beam
