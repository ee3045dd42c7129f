// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/presets.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/fields_json.h"
#include "core/base/json_words.h"
#include "core/io/file.h"

namespace beam {

std::vector<std::string> presetNamesIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const std::filesystem::directory_entry& entry : entriesOf(folder)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  const std::vector<std::string> first = {"draft", "standard", "paper"};
  const auto rank = [&](const std::string& name) {
    return std::pair(std::find(first.begin(), first.end(), name) - first.begin(), name);
  };
  std::sort(names.begin(), names.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return names;
}

std::map<std::string, FieldValue> loadPreset(const std::filesystem::path& folder, const std::string& name) {
  const std::vector<std::string> known = presetNamesIn(folder);
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw Error(Error::Kind::Usage,
                noSuchName("preset", name, known, fmt::format("there are {}", fmt::join(known, ", "))));
  }
  const std::filesystem::path file = folder / (name + ".json");
  std::map<std::string, FieldValue> values;
  try {
    const auto json = nlohmann::ordered_json::parse(readTextFile(file));
    for (const auto& [key, value] : json.items()) values[key] = parseFieldValue(value.dump());
  } catch (const nlohmann::json::exception& e) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\" cannot be understood: {}", file.string(), jsonComplaint(e)));
  }
  return values;
}

}  // namespace beam
