// SPDX-License-Identifier: Apache-2.0
// As-rigid-as-possible motion between two frames (BEAM eq. 9; methods 3.3).
#pragma once

#include "core/optim/anchors.h"

namespace beam {

// E = sum_i sum_k w_ik | R(q_i q'_i^-1) (x'_i - x'_k) - (x_i - x_k) |^2 over the graph, ' = `before`; a plain
// sum over i, in square metres. Adds weight * dE/d(now) to `gradient`; returns E without the weight.
double rigidEnergy(const Anchors& graph, const AnchorLists& lists, const Pose& before, const Pose& now,
                   float weight, PoseGradient& gradient);

}  // namespace beam
