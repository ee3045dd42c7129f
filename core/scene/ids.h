// SPDX-License-Identifier: Apache-2.0
// The indices of the house; none converts to another.
#pragma once

#include "core/base/strong_id.h"

namespace beam {

using FrameIndex = StrongId<struct FrameTag>;        // position in a capture's list of frames
using ViewIndex = StrongId<struct ViewTag>;          // position in a capture's list of views
using GaussianIndex = StrongId<struct GaussianTag>;  // position in a cloud

}  // namespace beam
