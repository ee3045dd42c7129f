// SPDX-License-Identifier: Apache-2.0
// Opens a panorama to relight with.
#pragma once

#include <filesystem>
#include <memory>

#include "core/base/progress.h"
#include "core/scene/environment.h"

namespace beam {

// Texels of a sky that is shown, at most; more are not seen behind a subject. Light falls from fewer
// (kWidestLight of render/prepared_light.h).
inline constexpr int kWidestSky = 8192;

// Throws what readRadiance and makeEnvironment throw, Cancelled when the progress is stopped. A wider one is
// made smaller, with a line in the log.
std::shared_ptr<const Environment> openPanorama(const std::filesystem::path& file,
                                                const Progress& progress = Progress{});

}  // namespace beam
