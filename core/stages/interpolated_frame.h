// SPDX-License-Identifier: Apache-2.0
// Frames that a scout run left out, made from the solved ones beside them when they are asked for; nothing of
// them is kept.
#pragma once

#include <optional>

#include "core/pipeline/frame_result.h"
#include "core/scene/pose.h"

namespace beam {

// What to show of the frame: its own result, else one interpolated between its neighbours in a take with a
// stride; empty when there is neither. The joints may start anew between two frames: then there is nothing.
std::optional<FrameResult> loadShownFrame(const Project& project, FrameIndex frame);
// For viewers, which keep showing what was made with other settings, marked stale, until there is better:
// materials in force; else the newest materials on the surface in force; else what the function above gives;
// else the newest of all `leftovers` (TakeSurvey::leftovers of the frame). Of a project without its capture
// only these.
std::optional<FrameResult> loadShownFrame(const Project& project, FrameIndex frame,
                                          const Leftovers& leftovers);
// The mesh of the surface that the function above shows.
std::optional<Mesh> loadShownMesh(const Project& project, FrameIndex frame, const Leftovers& leftovers);

// The joints between two solved frames; empty where one has none or they start anew.
std::optional<Pose> jointsBetween(const Project& project, const Between& between);

// The frame has no result of its own and lies between two that have one. Reads no Gaussians.
std::optional<Between> solvedAround(const Project& project, FrameIndex frame);

}  // namespace beam
