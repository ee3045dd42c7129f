// SPDX-License-Identifier: Apache-2.0
// Words that people type for a command that has another name here.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beam {

struct TypedWords {
  std::vector<std::string_view> words;
  std::vector<std::string_view> lines;  // what is typed for it here, as a rule "beam COMMAND"
};
const std::vector<TypedWords>& typedWords();

// "beam new or beam check"; nothing: nobody is known to mean a command by that word.
std::optional<std::string> meantBy(std::string_view word);

}  // namespace beam
