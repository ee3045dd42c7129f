// SPDX-License-Identifier: Apache-2.0
// LIST of the command line: "0-7", "1,5", "12-", "1-9x2", "all" or "ALL", with blanks; numbers as in the
// capture's own frame names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/ids.h"

namespace beam {

// Whether the list is the one word "all", however it is written.
bool isAllFrames(std::string_view list);

// Positions in `frames` (the capture's names), ascending, each once. An item may also be a whole frame name.
// Throws Error{Usage} for words it does not understand and for numbers that the capture does not have.
std::vector<FrameIndex> parseFrameList(std::string_view list, const std::vector<std::string>& frames);

// The other way: "000003-000007" and "000009" of frames in order, by name and by position in the capture.
std::vector<std::string> frameRanges(const std::vector<std::string>& names,
                                     const std::vector<int>& positions);

}  // namespace beam
