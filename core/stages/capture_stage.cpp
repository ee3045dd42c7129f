// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/file.h"
#include "core/io/mesh_ply.h"
#include "core/pipeline/input_digests.h"
#include "core/stages/builtin_stages.h"
#include "core/stages/screening_file.h"
#include "core/stages/step_ids.h"
#include "core/stages/training_input.h"

namespace beam {
namespace {

struct CaptureOptions {
  int downscale = 1;  // pictures are used this many times smaller a side
  bool screen = true;
};

void describe(Fields& fields, CaptureOptions& options) {
  fields.field(
      {.name = "downscale",
       .label = "Downscale",
       .help = "Pictures are used this many times smaller on each side; the paper uses them as they are.",
       .min = 1,
       .max = 16,
       .unit = "times"},
      options.downscale);
  fields.group("screen", [&] {
    fields.field(
        {.name = "enabled",
         .label = "Leave bad cameras out",
         .help = "Cameras that are black, blurred or of another moment are left out of the fit of the frames "
                 "where they are so: at most a quarter of them, and at least three remain."},
        options.screen);
  });
}

class CaptureStage final : public StageOf<CaptureOptions> {
 public:
  const StageInfo& info() const override {
    static const StageInfo kInfo{.id = "capture",
                                 .title = "Capture",
                                 .summary = "Reads cameras, masks and seed points of the capture.",
                                 .steps = {{.id = "import",
                                            .title = "Import the capture",
                                            .per_frame = false,
                                            .reads = {Reads::Calibration},
                                            .weight = 0.1,
                                            .shown = {.cameras_file = kCamerasFile}},
                                           {.id = "screen",
                                            .title = "Look for bad cameras",
                                            .version = 2,
                                            .reads = {Reads::Pictures},
                                            .inputs = {kImportStep},
                                            .weight = 0.5,
                                            .work = {.photographs = true, .pixels = true}}}};
    return kInfo;
  }

  void run(std::string_view step, StepContext& c) const override {
    step == "import" ? importCapture(c) : screen(c);
  }

 private:
  // The result holds what was understood; pictures stay where they are.
  static void importCapture(StepContext& c) {
    writeFileAtomically(c.folder / kCamerasFile, calibrationText(c.capture));
    if (!c.capture.seed_points.position_m.empty()) {
      writePointsPly(c.folder / "seed_points.ply", c.capture.seed_points);
    }
    int train = 0;
    for (const View& view : c.capture.views) train += view.split == Split::Train;
    if (train < kLeastTrainingCameras) {
      throw Error(Error::Kind::Data, fmt::format("the capture has {}, at least {} are needed; hold fewer out",
                                                 countText(train, "training camera"), kLeastTrainingCameras));
    }
    c.scores["training_cameras"] = train;
    c.scores["test_cameras"] = static_cast<double>(c.capture.views.size()) - train;
  }

  void screen(StepContext& c) const {
    FrameScreening kept{options_.screen, 0, {}, {}};
    Screening found;
    if (options_.screen) {
      const LentViews lent = readableViews(c);
      const std::vector<FrameView>& views = lent.all();
      kept.cameras = views.size();
      found = screenViews(views, {}, c.progress);
      const auto first_kept = found.suspects.begin() + static_cast<std::ptrdiff_t>(found.to_leave_out);
      kept.left_out.assign(found.suspects.begin(), first_kept);
      kept.suspects.assign(first_kept, found.suspects.end());
    }
    std::sort(kept.left_out.begin(), kept.left_out.end(),
              [](const ScreenedView& a, const ScreenedView& b) { return a.camera < b.camera; });
    const std::string& frame = c.capture.frames[static_cast<std::size_t>(c.frame.value)];
    for (const ScreenedView& v : kept.left_out) {
      logWarning("frame {}: camera {} {}; the frame is fitted without it, from {} of {}", frame, v.camera,
                 v.text, kept.cameras - kept.left_out.size(), countText(kept.cameras, "camera"));
    }
    for (const ScreenedView& v : kept.suspects) {
      logWarning(
          "frame {}: camera {} {}; it is used all the same, because too few of the {} cameras would remain "
          "without every one like it",
          frame, v.camera, v.text, kept.cameras);
    }
    writeScreening(c.folder, kept, found.figures);
    c.scores["left_out"] = static_cast<double>(kept.left_out.size());
  }
};

}  // namespace

std::unique_ptr<Stage> makeCaptureStage() { return std::make_unique<CaptureStage>(); }

}  // namespace beam
