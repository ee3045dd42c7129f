// SPDX-License-Identifier: Apache-2.0
#include "core/base/fields_json.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

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

std::string fieldsToJson(const std::vector<Field>& fields) {
  nlohmann::ordered_json j = nlohmann::ordered_json::object();
  for (const Field& f : fields) std::visit([&](const auto& v) { j[f.info.name] = v; }, f.value);
  return j.dump(2);
}

}  // namespace beam
