// SPDX-License-Identifier: Apache-2.0
// The steps that ship with the house.
#pragma once

#include "core/pipeline/step_id.h"

namespace beam {

inline const StepId kImportStep("capture.import");
inline const StepId kScreenStep("capture.screen");
inline const StepId kLightStep("light.import");
inline const StepId kJointsStep("track.joints");
inline const StepId kSeedStep("surface.seed");
inline const StepId kFitStep("surface.fit");
inline const StepId kRefineStep("surface.refine");
inline const StepId kScoreStep("surface.score");
inline const StepId kMeshStep("surface.mesh");
inline const StepId kBakeStep("materials.bake");
inline const StepId kMaterialsStep("materials.fit");
inline const StepId kVisibilityStep("materials.visibility");

}  // namespace beam
