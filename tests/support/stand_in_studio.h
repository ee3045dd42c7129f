// SPDX-License-Identifier: Apache-2.0
// A studio over stand-ins: a take of six small frames in memory and stages that finish at once, or wait as
// long as a test wants. For tests of the window, not of what it computes.
#pragma once

#include <filesystem>

#include "ui/studio_services.h"

namespace beam::testing {

inline constexpr int kStandInFrames = 6;

// The capture is any folder that exists; pictures of every camera and frame differ.
StudioServices standInServices();
// Steps of surface.fit wait from now on until they are let go, or are cancelled.
void holdStandInRuns(bool hold);
// Makes `folder`/capture, and `folder`/capture.beam with every frame solved.
void copySolvedStandIn(const std::filesystem::path& folder);

}  // namespace beam::testing
