// SPDX-License-Identifier: Apache-2.0
// The dance of the figure in a take: from a calm stand the arms cross before the chest, the body turns by 180
// degrees in small steps, the arms open wide and sink. The second half is its mirror; it goes on without end,
// later rounds a little different.
#pragma once

#include "core/sample/pose.h"

namespace beam {

constexpr double kDanceFrames_s = 30;  // frames of the dance a second
constexpr double kDanceHalf_frames = 30;

// Continuous with its first derivative in time.
BodyPose danceAt(double frame);

// The turn of the body about the vertical since frame 0.
double danceYaw_deg(double frame);

}  // namespace beam
