// SPDX-License-Identifier: Apache-2.0
#include "core/base/fields_json.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/word_list.h"

namespace beam {

FieldValue parseFieldValue(std::string_view text) {
  const nlohmann::json j = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (j.is_discarded()) return std::string(text);
  if (j.is_boolean()) return j.get<bool>();
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
  if (j.is_number_unsigned() && j.get<std::uint64_t>() > kMost) return j.get<double>();
  if (j.is_number_integer()) {
    const auto v = j.get<std::int64_t>();
    if (v >= std::numeric_limits<int>::min() && v <= std::numeric_limits<int>::max())
      return static_cast<int>(v);
    return static_cast<double>(v);
  }
  if (j.is_number()) return j.get<double>();
  if (j.is_string()) return j.get<std::string>();
  throw Error(Error::Kind::Usage, fmt::format("expected a JSON scalar, found {}", text));
}

FieldValue parseFieldValue(std::string_view text, const FieldValue& like) {
  if (std::holds_alternative<bool>(like)) {
    const std::string word = lowerCase(text);
    if (word == "true" || word == "yes" || word == "on" || word == "1") return true;
    if (word == "false" || word == "no" || word == "off" || word == "0") return false;
    return parseFieldValue(text);
  }
  if (std::holds_alternative<std::string>(like)) {
    const FieldValue value = parseFieldValue(text);
    return std::holds_alternative<std::string>(value) ? value : FieldValue(std::string(text));
  }
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double number = 0;
  const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (failed != std::errc() || end != digits.data() + digits.size() || !std::isfinite(number))
    return parseFieldValue(text);
  const bool whole = number == std::floor(number) && std::abs(number) <= std::numeric_limits<int>::max();
  if (std::holds_alternative<int>(like) && whole) return static_cast<int>(number);
  return number;
}

std::string fieldsToJson(const std::vector<Field>& fields) {
  nlohmann::ordered_json j = nlohmann::ordered_json::object();
  for (const Field& f : fields) std::visit([&](const auto& v) { j[f.info.name] = v; }, f.value);
  return j.dump(2);
}

}  // namespace beam
