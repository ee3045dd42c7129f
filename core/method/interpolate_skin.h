// SPDX-License-Identifier: Apache-2.0
// A frame that was left out between two solved frames a and b of one take: `share` 0 is a, 1 is b. Every
// joint goes along the screw that carries it from a to b, so that limbs turn instead of shrinking along
// chords; the skin is warped by the joints, and what is left of either end is carried along.
#pragma once

#include "core/method/follow_surface.h"

namespace beam {

// Rigid motion a -> b of each joint as a screw, the shorter way round; a joint near a half turn goes the way
// of its neighbours. Throws Error{Data} when the counts differ.
Pose interpolateJoints(const Pose& a, const Pose& b, double share);

// `rest_joints`: of the rest frame of both. Sizes, opacity and colour blend linearly in physical values.
// Throws Error{Data} when the counts of Gaussians or joints differ.
GaussianCloud interpolateSkin(const CarriedSkin& a, const CarriedSkin& b, const Pose& rest_joints,
                              double share);

// Linear in physical values. Throws Error{Data} when the counts differ.
Materials interpolateMaterials(const Materials& a, const Materials& b, double share);
ShBlock interpolateSh(const ShBlock& a, const ShBlock& b, double share);

}  // namespace beam
