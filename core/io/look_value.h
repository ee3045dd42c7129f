// SPDX-License-Identifier: Apache-2.0
// A look as a member of another document; for sources of core/io only.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/scene/look.h"

namespace beam {

nlohmann::ordered_json lookToValue(const Look& look);
// Throws Error{Data} that begins with `place`, also for a look that is not valid.
Look lookFromValue(nlohmann::json value, const std::string& place);

}  // namespace beam
