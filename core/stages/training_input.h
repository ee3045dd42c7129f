// SPDX-License-Identifier: Apache-2.0
// The views of a step's frame, as capture.downscale wants them.
#pragma once

#include <vector>

#include "core/pipeline/stage.h"
#include "core/scene/frame_views.h"

namespace beam {

// The step must have "capture.import" among its inputs: its key then holds the downscale.
int trainingDownscale(const StepContext& context);
std::vector<FrameView> trainingViews(const StepContext& context);
// For scores, never for fitting; the step reads Reads::HeldOut.
std::vector<FrameView> heldOutViews(const StepContext& context);
std::vector<Camera> trainingCameras(const StepContext& context);

}  // namespace beam
