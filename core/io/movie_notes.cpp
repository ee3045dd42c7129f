// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "core/io/movie_file.h"

namespace beam {
namespace {

constexpr int kMostBoxes = 1000;  // side by side; movies have some ten
constexpr std::uint64_t kMostText = 64 * 1024;

struct Stretch {
  std::uint64_t begin, end;
};

std::uint64_t bigEndian(std::istream& in, int bytes) {
  std::uint64_t v = 0;
  for (int k = 0; k < bytes; ++k) v = v << 8 | static_cast<std::uint8_t>(in.get());
  return v;
}

// The content of the first box of that type in `where` (ISO/IEC 14496-12, 4.2: length with the header, type).
std::optional<Stretch> box(std::istream& in, Stretch where, std::string_view type) {
  for (int i = 0; i < kMostBoxes && where.end - where.begin >= 8; ++i) {
    in.seekg(static_cast<std::streamoff>(where.begin));
    std::uint64_t length = bigEndian(in, 4), header = 8;
    std::string found(4, '\0');
    in.read(found.data(), 4);
    if (length == 1) {
      length = bigEndian(in, 8);
      header = 16;
    }
    if (length == 0) length = where.end - where.begin;
    if (!in || length < header || length > where.end - where.begin) return std::nullopt;
    if (found == type) return Stretch{where.begin + header, where.begin + length};
    where.begin += length;
  }
  return std::nullopt;
}

// Where iTunes and ffmpeg have it: moov, udta, meta, ilst, \251cmt, data, the text after kind and language.
std::string commentIn(std::istream& in, Stretch whole) {
  std::optional<Stretch> at = box(in, whole, "ftyp");
  if (!at || at->begin != 8) return {};  // no movie
  at = whole;
  for (const std::string_view type : {"moov", "udta", "meta", "ilst", "\251cmt", "data"}) {
    at = box(in, *at, type);
    if (!at) return {};
    if (type == "meta") at->begin = std::min(at->begin + 4, at->end);  // version and flags
  }
  if (at->end - at->begin < 8 || at->end - at->begin > kMostText) return {};
  std::string text(at->end - at->begin - 8, '\0');
  in.seekg(static_cast<std::streamoff>(at->begin + 8));
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  return in ? text : std::string();
}

}  // namespace

FileNotes notesOfMovie(const std::filesystem::path& file) {
  std::error_code out_of_reach;
  if (!std::filesystem::is_regular_file(file, out_of_reach)) return {};
  const std::uintmax_t bytes = std::filesystem::file_size(file, out_of_reach);
  if (out_of_reach) return {};
  std::ifstream in(file, std::ios::binary);
  std::istringstream lines(commentIn(in, {0, bytes}));
  FileNotes notes;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t name_end = std::min(line.find(' '), line.size());
    notes.emplace_back(line.substr(0, name_end), line.substr(std::min(name_end + 1, line.size())));
  }
  return notes;
}

}  // namespace beam
