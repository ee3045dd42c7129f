// SPDX-License-Identifier: Apache-2.0
// JSON documents of captures with errors that name file and place; for sources of core/io only.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/error.h"
#include "core/base/json_words.h"

namespace beam {

// NaN and Infinity, which some exporters write, are no JSON: they are read as the words they are, so that
// the message of finiteNumber can name the camera and the field.
nlohmann::json readJson(const std::filesystem::path& path);

double finiteNumber(const nlohmann::json& object, const char* key, const std::string& where);
// A picture's width or height; whole numbers written as floats are fine.
int pictureSide(const nlohmann::json& object, const char* key, const std::string& where);

// Runs body(); a value of another type than the reader asks for becomes Error{Data} that names the file.
template <class Body>
auto withJsonErrors(const std::filesystem::path& path, Body&& body) {
  try {
    return body();
  } catch (const nlohmann::json::exception& e) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": a value has another type than expected: {}",
                                               path.string(), jsonComplaint(e)));
  }
}

}  // namespace beam
