// SPDX-License-Identifier: Apache-2.0
// What the JSON of the commands holds: one table for the help and for the test that compares it with what the
// commands print.
#pragma once

#include <string>
#include <vector>

namespace beam {

struct JsonKey {
  // From the top, with dots: "[]" is every element of a list, "*" every name of an object whose names are
  // data. An object or list without a row for its parts holds what `meaning` says.
  std::string path;
  std::string meaning;
};

struct JsonAnswer {
  std::string command;  // "status"; "run --dry-run" where flags make another answer of it
  std::vector<JsonKey> keys;
};

const std::vector<JsonAnswer>& jsonAnswers();

}  // namespace beam
