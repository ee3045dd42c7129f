// SPDX-License-Identifier: Apache-2.0
#include "core/stages/training_input.h"

namespace beam {

int trainingDownscale(const StepContext& context) {
  return std::get<int>(context.setting("capture.downscale"));
}

std::vector<FrameView> trainingViews(const StepContext& context) {
  return loadFrameViews(context.capture, context.frame, Split::Train, trainingDownscale(context),
                        context.progress);
}

std::vector<FrameView> heldOutViews(const StepContext& context) {
  return loadFrameViews(context.capture, context.frame, Split::Test, trainingDownscale(context),
                        context.progress);
}

std::vector<Camera> trainingCameras(const StepContext& context) {
  std::vector<Camera> cameras;
  for (const View& view : context.capture.views) {
    if (view.split == Split::Train) cameras.push_back(scaledDown(view.camera, trainingDownscale(context)));
  }
  return cameras;
}

}  // namespace beam
