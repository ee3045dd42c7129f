// SPDX-License-Identifier: Apache-2.0
// What `beam status` and `beam stages` say, for people and as JSON.
#pragma once

#include <string>

#include "core/pipeline/project.h"

namespace beam {

const char* toText(StepState state);  // "done"

std::string statusText(const Project& project);
std::string statusJson(const Project& project);

// Stages, steps and every setting with default, range and help.
std::string stagesText(const StageRegistry& stages);
std::string stagesJson(const StageRegistry& stages);

}  // namespace beam
