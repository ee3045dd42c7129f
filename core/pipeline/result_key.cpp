// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/result_key.h"

#include <fmt/format.h>

namespace beam {
namespace {

constexpr std::string_view kPrevious = "previous ";

}  // namespace

std::string canonicalText(const KeyIngredients& ingredients) {
  std::string text = fmt::format("step {}\nversion {}\n", ingredients.step.text(), ingredients.version);
  if (ingredients.later) text += "later\n";
  // Values may be any text: their length keeps two different lists from reading alike.
  for (const auto& [name, value] : ingredients.parameters) {
    text += fmt::format("parameter {} {}:{}\n", name, value.size(), value);
  }
  for (const auto& [name, digest] : ingredients.inputs)
    text += fmt::format("input {} {}\n", name, digest.hex());
  for (const auto& [name, key] : namedResults(ingredients))
    text += fmt::format("result {} {}\n", name, key.hex());
  return text;
}

Digest keyOf(const KeyIngredients& ingredients) { return digestOf(canonicalText(ingredients)); }

std::map<std::string, Digest> namedResults(const KeyIngredients& ingredients) {
  std::map<std::string, Digest> named;
  for (const auto& [step, key] : ingredients.upstream) named[step.text()] = key;
  for (const auto& [step, key] : ingredients.previous) named[std::string(kPrevious) + step.text()] = key;
  return named;
}

void setNamedResults(KeyIngredients& ingredients, const std::map<std::string, Digest>& named) {
  for (const auto& [name, key] : named) {
    if (name.starts_with(kPrevious)) {
      ingredients.previous[StepId(name.substr(kPrevious.size()))] = key;
    } else {
      ingredients.upstream[StepId(name)] = key;
    }
  }
}

bool entersKey(const FieldInfo& field, std::string_view step, bool later) {
  if (field.effect != Effect::Result) return false;
  const std::size_t dot = field.name.find('.');
  if (dot == std::string::npos) return true;
  const std::string_view group = std::string_view(field.name).substr(0, dot);
  return group == step || (later && group == "later");
}

}  // namespace beam
