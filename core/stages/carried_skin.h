// SPDX-License-Identifier: Apache-2.0
// The skin of a solved frame, read back as later frames and interpolation take it.
#pragma once

#include <filesystem>

#include "core/method/follow_surface.h"
#include "core/scene/gaussian_sequence.h"

namespace beam {

// Carried there from the frame before; false: fitted anew, its own rest. `skin`: folder of surface.fit or
// surface.refine.
bool isCarried(const std::filesystem::path& skin);

// `cloud`: the frame's Gaussians. `joints`: folder of its track.joints, read for a frame that was fitted
// anew; null: its joints stay empty.
CarriedSkin readCarriedSkin(GaussianCloud cloud, const std::filesystem::path& skin,
                            const std::filesystem::path* joints);
// Without the Gaussians.
CarriedPose readCarriedPose(const std::filesystem::path& skin, const std::filesystem::path& joints);

}  // namespace beam
