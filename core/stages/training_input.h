// SPDX-License-Identifier: Apache-2.0
// The views of a step's frame, as capture.downscale wants them.
#pragma once

#include <vector>

#include "core/pipeline/frame_store.h"
#include "core/pipeline/stage.h"
#include "core/scene/frame_views.h"

namespace beam {

// How many times smaller a side photographs are used.
inline constexpr const char* kDownscale = "capture.downscale";
// The step must have "capture.import" among its inputs: its key then holds the downscale.
int trainingDownscale(const StepContext& context);
// Every training view with a readable picture, good or bad.
LentViews readableViews(const StepContext& context);
// For scores, never for fitting; the step reads Reads::HeldOut.
LentViews heldOutViews(const StepContext& context);

// What a frame is fitted to: the step must have "capture.screen" among its inputs, too. Without the cameras
// that it leaves out of this frame.
LentViews trainingViews(const StepContext& context);
std::vector<View> trainingCalibration(const StepContext& context);
std::vector<Camera> trainingCameras(const StepContext& context);
// The readable views that the frame is fitted without; for scores.
LentViews leftOutViews(const StepContext& context);

}  // namespace beam
