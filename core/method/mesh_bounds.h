// SPDX-License-Identifier: Apache-2.0
// Where a subject stands that no mask cuts out of what is around it.
#pragma once

#include <span>

#include "core/base/progress.h"
#include "core/method/tsdf.h"

namespace beam {

// The box of what the cameras look at: surfaces that at least half as many cameras picture as the best seen
// one, around the point nearest to their axes and no further from it than they are; without the outermost in
// each direction. Where the axes tell no point, of all such surfaces.
FusionBounds boundsFromCameras(std::span<const DepthView> views, const Progress& progress);

}  // namespace beam
