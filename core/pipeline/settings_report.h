// SPDX-License-Identifier: Apache-2.0
// What `beam stages` says, for people and as JSON: stages, steps and every setting with default, range, help
// and what each preset says; of a project also the value in force and where it comes from.
#pragma once

#include <string>

#include "core/pipeline/project.h"

namespace beam {

// `project` may be null.
std::string stagesText(const PipelineSetup& setup, const Project* project = nullptr);
std::string stagesJson(const PipelineSetup& setup, const Project* project = nullptr);

}  // namespace beam
