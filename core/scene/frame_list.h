// SPDX-License-Identifier: Apache-2.0
// LIST of the command line: "0-7", "1,5", "1-9x2", "all"; numbers as in the capture's own frame names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/ids.h"

namespace beam {

// Positions in `frames` (the capture's names), ascending, each once. An item may also be a whole frame name.
// Throws Error{Usage} for words it does not understand and for numbers that the capture does not have.
std::vector<FrameIndex> parseFrameList(std::string_view list, const std::vector<std::string>& frames);

}  // namespace beam
