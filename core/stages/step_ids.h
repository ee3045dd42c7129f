// SPDX-License-Identifier: Apache-2.0
// Full ids of the steps that ship with the house. Never renamed: results are found by them.
#pragma once

namespace beam {

inline constexpr const char* kImportStep = "capture.import";
inline constexpr const char* kScreenStep = "capture.screen";
inline constexpr const char* kLightStep = "light.import";
inline constexpr const char* kJointsStep = "track.joints";
inline constexpr const char* kSeedStep = "surface.seed";
inline constexpr const char* kFitStep = "surface.fit";
inline constexpr const char* kRefineStep = "surface.refine";
inline constexpr const char* kScoreStep = "surface.score";
inline constexpr const char* kMeshStep = "surface.mesh";
inline constexpr const char* kBakeStep = "materials.bake";
inline constexpr const char* kMaterialsStep = "materials.fit";

}  // namespace beam
