// SPDX-License-Identifier: Apache-2.0
#include "core/stages/training_input.h"

#include "core/stages/screening_file.h"

namespace beam {
namespace {

FrameScreening screeningOf(const StepContext& context) {
  return readScreening(context.input("capture.screen"));
}

}  // namespace

int trainingDownscale(const StepContext& context) {
  return std::get<int>(context.setting("capture.downscale"));
}

std::vector<FrameView> readableViews(const StepContext& context) {
  return loadFrameViews(context.capture, context.frame, Split::Train, trainingDownscale(context),
                        context.progress);
}

std::vector<FrameView> heldOutViews(const StepContext& context) {
  return loadFrameViews(context.capture, context.frame, Split::Test, trainingDownscale(context),
                        context.progress);
}

std::vector<FrameView> trainingViews(const StepContext& context) {
  const FrameScreening screening = screeningOf(context);
  std::vector<FrameView> views = readableViews(context);
  std::erase_if(views, [&](const FrameView& v) { return screening.leavesOut(v.name); });
  return views;
}

std::vector<View> trainingCalibration(const StepContext& context) {
  const FrameScreening screening = screeningOf(context);
  std::vector<View> views;
  for (const View& view : context.capture.views) {
    if (view.split != Split::Train || screening.leavesOut(view.name)) continue;
    views.push_back({view.name, scaledDown(view.camera, trainingDownscale(context)), view.split});
  }
  return views;
}

std::vector<Camera> trainingCameras(const StepContext& context) {
  std::vector<Camera> cameras;
  for (const View& view : trainingCalibration(context)) cameras.push_back(view.camera);
  return cameras;
}

std::vector<FrameView> leftOutViews(const StepContext& context) {
  const FrameScreening screening = screeningOf(context);
  if (screening.left_out.empty()) return {};
  std::vector<FrameView> views = readableViews(context);
  std::erase_if(views, [&](const FrameView& v) { return !screening.leavesOut(v.name); });
  return views;
}

}  // namespace beam
