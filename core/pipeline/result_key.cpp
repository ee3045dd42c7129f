// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/result_key.h"

#include <fmt/format.h>

namespace beam {

std::string canonicalText(const KeyIngredients& ingredients) {
  std::string text = fmt::format("step {}\nversion {}\n", ingredients.step, ingredients.version);
  if (ingredients.later) text += "later\n";
  // Values may be any text: their length keeps two different lists from reading alike.
  for (const auto& [name, value] : ingredients.parameters) {
    text += fmt::format("parameter {} {}:{}\n", name, value.size(), value);
  }
  for (const auto& [name, digest] : ingredients.inputs)
    text += fmt::format("input {} {}\n", name, digest.hex());
  for (const auto& [step, key] : ingredients.upstream) text += fmt::format("result {} {}\n", step, key.hex());
  return text;
}

Digest keyOf(const KeyIngredients& ingredients) { return digestOf(canonicalText(ingredients)); }

std::string previousName(std::string_view step) { return fmt::format("previous {}", step); }

bool entersKey(const FieldInfo& field, std::string_view step, bool later) {
  if (field.effect != Effect::Result) return false;
  const std::size_t dot = field.name.find('.');
  if (dot == std::string::npos) return true;
  const std::string_view group = std::string_view(field.name).substr(0, dot);
  return group == step || (later && group == "later");
}

}  // namespace beam
