// SPDX-License-Identifier: Apache-2.0
// What `beam status` says, for people and as JSON: what is done, and why what is not is not.
#pragma once

#include <string>

#include "core/pipeline/project.h"

namespace beam {

const char* toText(StepState state);  // "done"

std::string statusText(const Project& project);
std::string statusJson(const Project& project);

}  // namespace beam
