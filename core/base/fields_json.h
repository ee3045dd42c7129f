// SPDX-License-Identifier: Apache-2.0
// Fields <-> JSON text, and single values as typed on the command line.
#pragma once

#include <string>
#include <string_view>

#include "core/base/fields.h"

namespace beam {

// A JSON scalar ("2000", "0.5", "true", "\"text\""; a bare word is taken as text). Throws Error{Usage} for
// arrays and objects.
FieldValue parseFieldValue(std::string_view text);

// The same, as people type a value of the type of `like`: "yes" or "off" for true or false, ".5", "1e4" for a
// whole number, any word for text. What does not fit comes as above, for the range check to refuse.
FieldValue parseFieldValue(std::string_view text, const FieldValue& like);

// The fields as one flat JSON object {"name": value}, in order of declaration, indented by 2.
std::string fieldsToJson(const std::vector<Field>& fields);

}  // namespace beam
