// SPDX-License-Identifier: Apache-2.0
#include "core/stages/builtin_stages.h"

namespace beam {

void registerBuiltinStages(StageRegistry& registry) {
  registry.add(makeCaptureStage);
  registry.add(makeLightStage);
  registry.add(makeTrackStage);
  registry.add(makeSurfaceStage);
  registry.add(makeMaterialsStage);
  registry.add(makeRelightStage);
}

}  // namespace beam
