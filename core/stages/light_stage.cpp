// SPDX-License-Identifier: Apache-2.0
#include "core/io/image_file.h"
#include "core/scene/environment.h"
#include "core/stages/builtin_stages.h"
#include "core/stages/result_files.h"

namespace beam {
namespace {

struct LightOptions {
  double gain = 1;
};

void describe(Fields& fields, LightOptions& options) {
  fields.field(
      {.name = "gain",
       .label = "Gain",
       .help =
           "Factor on the radiance of the panorama, where it was exposed differently from the photographs.",
       .min = 1e-4,
       .max = 1e4,
       .unit = "times"},
      options.gain);
}

class LightStage final : public StageOf<LightOptions> {
 public:
  const StageInfo& info() const override {
    static const StageInfo kInfo{.id = "light",
                                 .title = "Light",
                                 .summary = "Reads the panorama of the light the capture stood in.",
                                 .steps = {{.id = "import",
                                            .title = "Import the panorama",
                                            .per_frame = false,
                                            .reads = {Reads::Environment},
                                            .weight = 0.1,
                                            .shown = {.panorama_file = kEnvironmentFile}}}};
    return kInfo;
  }

  void run(std::string_view, StepContext& c) const override {
    const Environment environment = makeEnvironment(readRadiance(c.environment.value()));
    const Image<vec3>& radiance = environment.radiance;
    Planes planes(radiance.width, radiance.height, 3);
    for (std::size_t i = 0; i < radiance.pixels.size(); ++i) {
      for (int k = 0; k < 3; ++k)
        planes.plane(k)[i] = radiance.pixels[i][k] * static_cast<float>(options_.gain);
    }
    writeExr(c.folder / kEnvironmentFile, planes, {"R", "G", "B"}, ExrPrecision::Float);
  }
};

}  // namespace

std::unique_ptr<Stage> makeLightStage() { return std::make_unique<LightStage>(); }

}  // namespace beam
