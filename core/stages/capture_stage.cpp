// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/io/mesh_ply.h"
#include "core/pipeline/input_digests.h"
#include "core/stages/builtin_stages.h"

namespace beam {
namespace {

struct CaptureOptions {
  int downscale = 1;  // pictures are used this many times smaller a side
};

void describe(Fields& fields, CaptureOptions& options) {
  fields.field({.name = "downscale",
                .label = "Downscale",
                .help = "Pictures are used this many times smaller a side (the paper uses them as they are).",
                .min = 1,
                .max = 16},
               options.downscale);
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
                                            .weight = 0.1}}};
    return kInfo;
  }

  // The result holds what was understood; pictures stay where they are.
  void run(std::string_view, StepContext& c) const override {
    writeFileAtomically(c.folder / "cameras.txt", calibrationText(c.capture));
    if (!c.capture.seed_points.position_m.empty()) {
      writePointsPly(c.folder / "seed_points.ply", c.capture.seed_points);
    }
    int train = 0;
    for (const View& view : c.capture.views) train += view.split == Split::Train;
    if (train < 2) {
      throw Error(Error::Kind::Data,
                  fmt::format("the capture has {} training cameras, at least 2 are needed; hold "
                              "fewer out",
                              train));
    }
    c.scores["training_cameras"] = train;
    c.scores["test_cameras"] = static_cast<double>(c.capture.views.size()) - train;
  }
};

}  // namespace

std::unique_ptr<Stage> makeCaptureStage() { return std::make_unique<CaptureStage>(); }

}  // namespace beam
