// SPDX-License-Identifier: Apache-2.0
// The sample capture that comes with the program: made once, later only opened.
#pragma once

#include <filesystem>

#include "ui/studio_services.h"

namespace beam {

// Where it lies in this person's data.
std::filesystem::path sampleFolder();
// Makes it unless it is there. A killed attempt never passes for a sample.
void makeSampleOnce(const StudioServices& services, Progress& progress);

}  // namespace beam
