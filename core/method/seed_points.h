// SPDX-License-Identifier: Apache-2.0
// Where a fit starts: points on the surface of what the views show.
#pragma once

#include <span>

#include "core/base/progress.h"
#include "core/scene/frame_views.h"

namespace beam {

// At most `count` seeds (methods 3.8), world axes, metres, with sRGB colours: points on the visual hull of
// the masks, coloured by the views, or of `seed_points` where the views carry no masks. Deterministic for a
// seed. Throws Error{Data} when neither gives a point.
PointCloud seedPoints(std::span<const FrameView> views, const PointCloud& seed_points, int count, int seed,
                      Progress& progress);

}  // namespace beam
