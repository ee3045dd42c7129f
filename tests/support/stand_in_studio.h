// SPDX-License-Identifier: Apache-2.0
// A studio over a stand-in project (stand_in_project.h). For tests of the window.
#pragma once

#include <filesystem>

#include "tests/support/stand_in_project.h"
#include "ui/studio_services.h"

namespace beam::testing {

StudioServices standInServices(const StandInSize& size = {});
// Makes `folder`/capture, and `folder`/capture.beam with every frame solved.
void copySolvedStandIn(const std::filesystem::path& folder);

}  // namespace beam::testing
