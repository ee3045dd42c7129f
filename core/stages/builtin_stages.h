// SPDX-License-Identifier: Apache-2.0
// The stages that ship with the house, by an explicit list in pipeline order.
#pragma once

#include "core/pipeline/stage_registry.h"

namespace beam {

void registerBuiltinStages(StageRegistry& registry);

std::unique_ptr<Stage> makeCaptureStage();
std::unique_ptr<Stage> makeLightStage();
std::unique_ptr<Stage> makeTrackStage();
std::unique_ptr<Stage> makeSurfaceStage();
std::unique_ptr<Stage> makeMaterialsStage();
std::unique_ptr<Stage> makeRelightStage();

}  // namespace beam
