// SPDX-License-Identifier: Apache-2.0
// What the key of a result is made of, in clear. Equal ingredients mean equal bytes; nothing else may enter:
// no path, time, thread count, device or instruction set.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fields.h"
#include "core/base/hash.h"

namespace beam {

struct KeyIngredients {
  std::string step;  // full id
  int version = 1;
  std::map<std::string, std::string>
      parameters;                          // full name -> value; only those that differ from the default
  std::map<std::string, Digest> inputs;    // "calibration", "pictures", "environment"
  std::map<std::string, Digest> upstream;  // full step id -> key of its result; see previousName()
  bool later = false;                      // builds on the frame before
};

// How `upstream` calls the result of a step in the frame before: "previous surface.refine".
std::string previousName(std::string_view step);

// One line a fact, sorted; equal on every machine.
std::string canonicalText(const KeyIngredients& ingredients);
Digest keyOf(const KeyIngredients& ingredients);

// Whether a stage's field (name without the stage id) has a say in a step: result fields that are ungrouped
// or in the group named after the step; of a later frame also those in the group "later".
bool entersKey(const FieldInfo& field, std::string_view step, bool later = false);

}  // namespace beam
