// SPDX-License-Identifier: Apache-2.0
#include "core/stages/training_input.h"

#include "core/stages/screening_file.h"
#include "core/stages/step_ids.h"

namespace beam {
namespace {

LentViews viewsThat(const StepContext& context, const FrameStore::Wanted& wanted) {
  const int downscale = trainingDownscale(context);
  if (context.frames) return context.frames->lend(context.frame, downscale, wanted, context.progress);
  std::vector<FrameView> views =
      loadFrameViews(context.capture, context.frame, Split::Train, downscale, context.progress);
  std::erase_if(views, [&](const FrameView& v) { return !wanted(v.name); });
  return LentViews(std::move(views));
}

FrameScreening screeningOf(const StepContext& context) { return readScreening(context.input(kScreenStep)); }

}  // namespace

int trainingDownscale(const StepContext& context) { return std::get<int>(context.setting(kDownscale)); }

LentViews readableViews(const StepContext& context) {
  return viewsThat(context, [](const std::string&) { return true; });
}

// One step of a frame asks for them, once: not worth keeping.
LentViews heldOutViews(const StepContext& context) {
  return LentViews(loadFrameViews(context.capture, context.frame, Split::Test, trainingDownscale(context),
                                  context.progress));
}

LentViews trainingViews(const StepContext& context) {
  const FrameScreening screening = screeningOf(context);
  return viewsThat(context, [&](const std::string& name) { return !screening.leavesOut(name); });
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

LentViews leftOutViews(const StepContext& context) {
  const FrameScreening screening = screeningOf(context);
  if (screening.left_out.empty()) return LentViews({});
  return viewsThat(context, [&](const std::string& name) { return screening.leavesOut(name); });
}

}  // namespace beam
