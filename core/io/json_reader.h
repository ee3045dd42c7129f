// SPDX-License-Identifier: Apache-2.0
// JSON documents of captures with errors that name file and place; for sources of core/io only.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {

// NaN and Infinity, which some exporters write, are no JSON: they are read as such so that the message can
// name the field.
inline nlohmann::json readJson(const std::filesystem::path& path) {
  std::string text = readTextFile(path);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& e) {
    const bool not_a_number =
        text.find("NaN") != std::string::npos || text.find("Infinity") != std::string::npos;
    throw Error(
        Error::Kind::Data,
        fmt::format("\"{}\" is no valid JSON{}: {}", path.string(),
                    not_a_number ? " (it holds NaN or Infinity, expected finite numbers)" : "", e.what()));
  }
}

inline double finiteNumber(const nlohmann::json& object, const char* key, const std::string& where) {
  if (!object.contains(key)) {
    throw Error(Error::Kind::Data, fmt::format("{}: expected a number \"{}\", found none", where, key));
  }
  const nlohmann::json& v = object.at(key);
  if (!v.is_number() || !std::isfinite(v.get<double>())) {
    throw Error(Error::Kind::Data,
                fmt::format("{}: expected \"{}\" to be a finite number, found {}", where, key, v.dump()));
  }
  return v.get<double>();
}

}  // namespace beam
