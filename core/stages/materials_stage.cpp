// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "core/io/image_file.h"
#include "core/io/splat_ply.h"
#include "core/io/visibility_ply.h"
#include "core/method/bake_materials.h"
#include "core/method/bake_visibility.h"
#include "core/method/evaluate_motion.h"
#include "core/method/fit_materials.h"
#include "core/stages/builtin_stages.h"
#include "core/stages/material_map_files.h"
#include "core/stages/result_files.h"
#include "core/stages/step_ids.h"
#include "core/stages/track_files.h"
#include "core/stages/training_input.h"

namespace beam {
namespace {

struct MaterialsOptions {
  BakeMaterialsOptions bake;
  FitMaterialsOptions fit;
};

void describe(Fields& fields, MaterialsOptions& options) {
  describe(fields, options.bake);
  fields.group("fit", [&] { describe(fields, options.fit); });
  fields.group("later", [&] { describe(fields, options.fit.later); });
}

class MaterialsStage final : public StageOf<MaterialsOptions> {
 public:
  const StageInfo& info() const override {
    static const StageInfo kInfo{
        .id = "materials",
        .title = "Materials",
        .summary = "Measures ambient occlusion and base colour and fits them to the Gaussians.",
        .steps = {{.id = "bake",
                   .title = "Bake maps",
                   .source = "BEAM 3.2, eq. 3 and 20",
                   .reads = {Reads::Pictures},
                   .inputs = {kImportStep, kScreenStep, kLightStep, kRefineStep},
                   .weight = 20,
                   .work = {.photographs = true,
                            .pixels = true,
                            .downscale = kDownscale,
                            .times = "materials.base_color_samples",
                            .later_times = "materials.base_color_samples"},
                   .memory = {.raise = {kDownscale}, .lower = {"surface.cap"}}},
                  {.id = "fit",
                   .title = "Fit materials",
                   .source = "BEAM 3.2",
                   .version = 3,
                   .inputs = {kImportStep, kScreenStep, kRefineStep, kBakeStep},
                   .weight = 10,
                   .later = {.inputs = {kJointsStep}, .previous = {kMaterialsStep}},
                   .work = {.photographs = true, .pixels = true, .downscale = kDownscale},
                   .memory = {.raise = {kDownscale}, .lower = {"surface.cap"}},
                   .shown = {.frame = true, .surface = kRefineStep, .last = true}},
                  {.id = "visibility",
                   .title = "Bake visibility",
                   .source = "methods 4.7",
                   .inputs = {kImportStep, kScreenStep, kRefineStep},
                   .weight = 2,
                   .memory = {.lower = {"surface.cap"}}}}};
    return kInfo;
  }

  void run(std::string_view step, StepContext& c) const override {
    if (step == "bake") return bake(c);
    step == "fit" ? fit(c) : visibility(c);
  }

 private:
  static GaussianCloud cloudOf(const StepContext& c) {
    return readSplatPly(c.input(kRefineStep) / kCloudFile).cloud;
  }

  void bake(StepContext& c) const {
    const Environment light = makeEnvironment(readRadiance(c.input(kLightStep) / kEnvironmentFile));
    const LentViews lent = trainingViews(c);
    const std::vector<FrameView>& views = lent.all();
    const std::filesystem::path folder = c.folder / kMapsFolder;
    std::filesystem::create_directory(folder);
    bakeMaterials(views, cloudOf(c), light, options_.bake, c.device, c.progress,
                  [&](std::size_t view, const MaterialMaps& maps) {
                    writeMaterialMaps(folder, views[view].name, maps);
                  });
  }

  void fit(StepContext& c) const {
    const std::filesystem::path folder = c.input(kBakeStep) / kMapsFolder;
    std::vector<View> baked;
    for (const View& view : trainingCalibration(c)) {
      if (hasMaterialMaps(folder, view.name)) baked.push_back(view);
    }
    const MapSource maps{
        baked.size(), [&](std::size_t i) { return readMaterialMaps(folder, baked[i].name, baked[i].camera); },
        [&](std::size_t i) { return readMaterialWeights(folder, baked[i].name, baked[i].camera); }};
    const GaussianCloud cloud = cloudOf(c);
    const Materials materials = materialsOf(c, maps, cloud);
    validate(materials, cloud);
    writeSplatPly(c.folder / kMaterialsFile, cloud, &materials);
    c.scores["views"] = static_cast<double>(baked.size());
  }

  void visibility(StepContext& c) const {
    const GaussianCloud cloud = cloudOf(c);
    Progress sides = c.progress.part(0.3, "sides of normals");
    SeenSurface surface = seenSurface(cloud, trainingCameras(c), c.device, sides);
    Progress rays = c.progress.part(0.7, "tracing");
    VisibilityFile file;
    file.visibility = bakeVisibility(cloud, surface,
                                     {.offset_m = options_.bake.offset_m,
                                      .threshold = options_.bake.threshold,
                                      .seed = static_cast<std::uint64_t>(options_.bake.seed)},
                                     c.device, rays);
    file.normal = std::move(surface.normal);
    writeVisibilityPly(c.folder / kVisibilityFile, file);
  }

  Materials materialsOf(StepContext& c, const MapSource& maps, const GaussianCloud& cloud) const {
    const bool follows = c.later() && !readTrackNote(c.input(kJointsStep)).restarted;
    if (!follows) {
      return fitMaterials(maps, cloud, static_cast<float>(options_.bake.roughness), options_.fit, c.device,
                          c.progress);
    }
    const SplatFile before = readSplatPly(*c.previousResult(kMaterialsStep) / kMaterialsFile);
    Materials materials =
        fitLaterMaterials(maps, cloud, {before.cloud, *before.materials}, options_.fit, c.device, c.progress);
    c.scores["flicker_base_color"] = baseColorFlicker(before.cloud, *before.materials, materials);
    return materials;
  }
};

}  // namespace

std::unique_ptr<Stage> makeMaterialsStage() { return std::make_unique<MaterialsStage>(); }

}  // namespace beam
