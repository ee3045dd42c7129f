// SPDX-License-Identifier: Apache-2.0
#include "app/cli/picture_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "core/base/error.h"

namespace beam {
namespace {

// The whole of it; 0: it is no number.
int sideOf(std::string_view digits) {
  int side = 0;
  const char* last = digits.data() + digits.size();
  const auto [end, failed] = std::from_chars(digits.data(), last, side);
  return failed == std::errc() && end == last ? side : 0;
}

}  // namespace

ivec2 parsePictureSize(std::string_view text) {
  constexpr int kLeast = 16, kMost = 8192;
  const std::size_t x = text.find('x');
  const int width = sideOf(text.substr(0, x));
  const int height = x == std::string_view::npos ? 0 : sideOf(text.substr(x + 1));
  if (std::min(width, height) < kLeast || std::max(width, height) > kMost) {
    throw Error(
        Error::Kind::Usage,
        fmt::format("--size expects WIDTHxHEIGHT of {} to {} pixels, found \"{}\"", kLeast, kMost, text));
  }
  return {width, height};
}

}  // namespace beam
