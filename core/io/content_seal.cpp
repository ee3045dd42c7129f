// SPDX-License-Identifier: Apache-2.0
#include "core/io/content_seal.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace beam {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kDigits = 32, kPngChecksum = 4;
constexpr char kZero = '0';
constexpr std::size_t kBeginning = 64 << 10;  // notes stand before what is large
constexpr std::size_t kPiece = 256 << 10;

struct SealForm {
  std::string_view magic, before;  // the file begins with; stands before the digits
  bool png = false;
};

constexpr std::array<SealForm, 3> kForms = {
    {{"\x89PNG\r\n\x1a\n"sv, "tEXtcontent\0"sv, true},
     {"\x76\x2f\x31\x01"sv, "content\0string\0\x20\0\0\0"sv},  // name, type, size
     {"ply\n"sv, "\ncomment content "sv}}};

struct SealPlace {
  std::size_t digits = 0, chunk_type = 0, bytes = kDigits;  // bytes: that count as kZero
};

std::optional<SealPlace> placeIn(std::string_view beginning) {
  for (const SealForm& form : kForms) {
    if (!beginning.starts_with(form.magic)) continue;
    const std::size_t at = beginning.find(form.before);
    if (at == std::string_view::npos) return std::nullopt;
    const SealPlace place = {at + form.before.size(), at, kDigits + (form.png ? kPngChecksum : 0)};
    if (place.digits + place.bytes > beginning.size()) return std::nullopt;
    return place;
  }
  return std::nullopt;
}

std::string_view textOf(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

FileNotes sealable(FileNotes notes) {
  if (!notes.empty()) notes.emplace_back(kContentNote, std::string(kDigits, kZero));
  return notes;
}

FileNotes sealed(FileNotes sealable_notes, const Digest& of_the_bytes) {
  if (!sealable_notes.empty()) sealable_notes.back().second = of_the_bytes.hex();
  return sealable_notes;
}

void seal(std::span<std::byte> file) {
  const auto place = placeIn(textOf(file.first(std::min(file.size(), kBeginning))));
  if (!place) return;
  const std::span<std::byte> ours = file.subspan(place->digits, place->bytes);
  std::fill(ours.begin(), ours.end(), std::byte{kZero});
  const std::string digits = digestOf(file).hex();
  std::memcpy(ours.data(), digits.data(), kDigits);
  if (place->bytes == kDigits) return;
  const auto* chunk = reinterpret_cast<const unsigned char*>(file.data() + place->chunk_type);
  const auto sum =
      static_cast<std::uint32_t>(::crc32_z(0, chunk, place->digits + kDigits - place->chunk_type));
  for (std::size_t k = 0; k < kPngChecksum; ++k)
    ours[kDigits + k] = static_cast<std::byte>(sum >> (24 - 8 * k));
}

bool isSealed(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<char> piece(kPiece);
  const auto read = [&] {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    return std::string_view(piece.data(), static_cast<std::size_t>(in.gcount()));
  };
  const std::string_view first = read();
  const auto place = placeIn(first.substr(0, kBeginning));
  if (!place) return false;
  const std::string digits(first.substr(place->digits, kDigits));
  std::fill_n(piece.begin() + static_cast<std::ptrdiff_t>(place->digits), place->bytes, kZero);
  Hasher hasher;
  hasher.add(first);
  for (std::string_view more = read(); !more.empty(); more = read()) hasher.add(more);
  return hasher.digest().hex() == digits;
}

}  // namespace beam
