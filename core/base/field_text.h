// SPDX-License-Identifier: Apache-2.0
// What a field takes, in words: the same ones on the command line and in the form.
#pragma once

#include "core/base/fields.h"

namespace beam {

// "2 to 1,000,000 frames", "at least 1", "" without limits.
std::string rangeText(const FieldInfo& info);
// "a whole number from 2 to 1,000,000". `like` is of the field's type.
std::string expectedText(const FieldInfo& info, const FieldValue& like);

}  // namespace beam
