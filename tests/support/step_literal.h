// SPDX-License-Identifier: Apache-2.0
// Steps as tests write them: "surface.fit"_step.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>

#include "core/pipeline/step_id.h"

namespace beam {

inline std::ostream& operator<<(std::ostream& out, const StepId& step) { return out << step.text(); }

namespace testing {

inline StepId operator""_step(const char* text, std::size_t size) { return StepId(std::string(text, size)); }

}  // namespace testing
}  // namespace beam
