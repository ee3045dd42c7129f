// SPDX-License-Identifier: Apache-2.0
#include "core/base/count_text.h"

#include <fmt/format.h>

namespace beam {
namespace {

// 1,234,567.
std::string grouped(std::int64_t n) {
  std::string digits = std::to_string(n);
  const std::size_t first = n < 0 ? 1 : 0;
  for (std::size_t at = digits.size(); at > first + 3;) digits.insert(at -= 3, 1, ',');
  return digits;
}

}  // namespace

std::string nounText(std::int64_t n, std::string_view one, std::string_view many) {
  if (n == 1) return std::string(one);
  return many.empty() ? fmt::format("{}s", one) : std::string(many);
}

std::string countText(std::int64_t n, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", grouped(n), nounText(n, one, many));
}

}  // namespace beam
