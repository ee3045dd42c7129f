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
#include "core/pipeline/step_id.h"

namespace beam {

struct KeyIngredients {
  StepId step;
  int version = 1;
  std::map<std::string, std::string>
      parameters;                          // full name -> value; only those that differ from the default
  std::map<std::string, Digest> inputs;    // "calibration", "pictures", "environment"
  std::map<StepId, Digest> upstream;       // keys of the results it reads
  std::map<StepId, Digest> previous = {};  // of those of the frame before
  bool later = false;                      // builds on the frame before
};

// Both kinds of results by the names that they have in keys and records: "surface.seed", and of the frame
// before "previous surface.refine".
std::map<std::string, Digest> namedResults(const KeyIngredients& ingredients);
void setNamedResults(KeyIngredients& ingredients, const std::map<std::string, Digest>& named);

// One line a fact, sorted; equal on every machine.
std::string canonicalText(const KeyIngredients& ingredients);
Digest keyOf(const KeyIngredients& ingredients);

// Whether a stage's field (name without the stage id) has a say in its step of that name: result fields that
// are ungrouped or in the group named after the step; of a later frame also those in the group "later".
bool entersKey(const FieldInfo& field, std::string_view step, bool later = false);

}  // namespace beam
