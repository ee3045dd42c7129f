// SPDX-License-Identifier: Apache-2.0
// The skeleton of the figure and its poses, in capture axes.
#pragma once

#include <array>

#include "core/math/types.h"

namespace beam {

namespace bone {
enum Id {
  Root,
  Chest,
  Head,
  LUpper,
  LFore,
  LHand,
  RUpper,
  RFore,
  RHand,
  LThigh,
  LShin,
  LFoot,
  RThigh,
  RShin,
  RFoot,
  Count
};
}  // namespace bone

// Rotations of the bones about their pivots, in the parent's frame.
struct BodyPose {
  BodyPose() { local.fill(mat3(1.0f)); }
  std::array<mat3, bone::Count> local;
  vec3 root_shift{0};
};

// Where the bones stand: x_posed = rotation * x_rest + translation.
struct PosedBones {
  std::array<mat3, bone::Count> rotation;
  std::array<vec3, bone::Count> translation;
};

vec3 bonePivot(int bone);  // rest pose, arms hanging in an A
PosedBones placeBones(const BodyPose& pose);
mat3 turnAbout(vec3 axis, double degrees);

// Of a capture of one frame: arms before the body.
BodyPose portraitPose();

}  // namespace beam
