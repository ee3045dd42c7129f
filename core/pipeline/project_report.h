// SPDX-License-Identifier: Apache-2.0
// What `beam status` says, for people and as JSON: what is done, and why what is not is not.
#pragma once

#include <string>

#include "core/pipeline/disk_use.h"
#include "core/pipeline/project.h"

namespace beam {

const char* toText(StepState state);  // "done"

std::string statusText(const Project& project);
std::string statusJson(const Project& project);

// "Disk" and a line a stage: "surface 210 MB, 340 MB not in force (beam clean)"; empty: no results.
std::string diskText(const DiskUse& use);
std::string diskJson(const DiskUse& use);

}  // namespace beam
