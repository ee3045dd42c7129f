// SPDX-License-Identifier: Apache-2.0
// What published results hold of a frame, read back from their files.
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "core/io/visibility_ply.h"
#include "core/pipeline/result_store.h"
#include "core/pipeline/take_survey.h"
#include "core/scene/gaussian_sequence.h"

namespace beam {

// `folder`: a result of kMaterialsStep, kRefineStep or kFitStep.
GaussianFrame readFrame(const StepId& step, const std::filesystem::path& folder);
// Adds what was baked of the same surface, kVisibilityName and kNormalSideName. `axes`: thinAxis of the
// Gaussians as they were when it was baked. Throws Error{Data}, which names the `folder` that it was read
// from, where it is of another number of Gaussians.
void addVisibility(VisibilityFile file, std::span<const vec3> axes, const std::filesystem::path& folder,
                   GaussianFrame& frame);
FrameJoints readJoints(const std::filesystem::path& folder);  // of kJointsStep

// --- Results of settings that are no longer in force: to look at, never to score or to export. Those that
// are damaged or of another version of the program are passed over. ---
// The newest materials that lie on `surface`.
std::optional<GaussianFrame> readOlderMaterials(const ResultStore& store, const Leftovers& leftovers,
                                                const Digest& surface);
// The newest with materials, else refined, else fitted.
std::optional<GaussianFrame> readLeftover(const ResultStore& store, const Leftovers& leftovers);
// The mesh of the surface that readLeftover shows.
std::optional<Mesh> readLeftoverMesh(const ResultStore& store, const Leftovers& leftovers);

}  // namespace beam
