// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/method/extract_mesh.h"
#include "core/method/fit_surface.h"
#include "core/method/score_views.h"
#include "core/pipeline/frame_result.h"
#include "core/stages/builtin_stages.h"
#include "core/stages/score_files.h"
#include "core/stages/training_input.h"

namespace beam {
namespace {

struct SurfaceOptions {
  FitSurfaceOptions fit;
  ExtractMeshOptions mesh;
};

void describe(Fields& fields, SurfaceOptions& options) {
  describe(fields, options.fit);
  fields.group("mesh", [&] { describe(fields, options.mesh); });
}

class SurfaceStage final : public StageOf<SurfaceOptions> {
 public:
  const StageInfo& info() const override {
    static const StageInfo kInfo{
        .id = "surface",
        .title = "Surface",
        .summary = "Fits Gaussians to the photographs of a frame and fuses a mesh from them.",
        .steps = {{.id = "seed",
                   .title = "Seed points",
                   .source = "BEAM 3.1",
                   .reads = {Reads::Pictures},
                   .inputs = {"capture.import"},
                   .weight = 1},
                  {.id = "fit",
                   .title = "Fit appearance",
                   .source = "BEAM 3.1, eq. 8",
                   .reads = {Reads::Pictures},
                   .inputs = {"capture.import", "surface.seed"},
                   .weight = 45},
                  {.id = "refine",
                   .title = "Refine geometry",
                   .source = "BEAM 3.1, E_normal",
                   .reads = {Reads::Pictures},
                   .inputs = {"capture.import", "surface.fit"},
                   .weight = 45},
                  {.id = "score",
                   .title = "Score against the photographs",
                   .reads = {Reads::Pictures, Reads::HeldOut},
                   .inputs = {"capture.import", "surface.refine"},
                   .weight = 2},
                  {.id = "mesh",
                   .title = "Fuse a mesh",
                   .inputs = {"capture.import", "surface.refine"},
                   .weight = 4}}};
    return kInfo;
  }

  void run(std::string_view step, StepContext& c) const override {
    if (step == "seed") return seed(c);
    if (step == "fit") return fit(c);
    if (step == "refine") return refine(c);
    if (step == "score") return score(c);
    mesh(c);
  }

 private:
  void seed(StepContext& c) const {
    const int count = static_cast<int>(options_.fit.seed_share * options_.fit.cap);
    const PointCloud seeds =
        seedPoints(trainingViews(c), c.capture.seed_points, count, options_.fit.seed, c.progress);
    writePointsPly(c.folder / kSeedsFile, seeds);
    c.scores["points"] = static_cast<double>(seeds.position_m.size());
  }

  void fit(StepContext& c) const {
    const PointCloud seeds = readPointsPly(c.input("surface.seed") / kSeedsFile);
    keep(c, fitAppearance(trainingViews(c), seeds, options_.fit, c.device, c.progress, c.preview));
  }

  void refine(StepContext& c) const {
    const GaussianCloud fitted = readSplatPly(c.input("surface.fit") / kCloudFile).cloud;
    keep(c, refineGeometry(trainingViews(c), fitted, options_.fit, c.device, c.progress, c.preview));
  }

  // At the resolution of the fit; `beam evaluate` scores the whole pictures.
  void score(StepContext& c) const {
    const GaussianCloud cloud = readSplatPly(c.input("surface.refine") / kCloudFile).cloud;
    std::vector<ViewScore> scores;
    for (const bool held_out : {false, true}) {
      Progress part = c.progress.part(0.5, held_out ? "held-out views" : "training views");
      const std::vector<FrameView> views = held_out ? heldOutViews(c) : trainingViews(c);
      for (ViewScore& s : scoreViews(views, held_out, cloud, c.device, part)) scores.push_back(std::move(s));
      const SplitScore split = meanOf(scores, held_out);
      if (split.n == 0) continue;
      const std::string name = held_out ? "_test" : "_train";
      c.scores["psnr" + name] = split.mean.psnr;
      c.scores["ssim" + name] = split.mean.ssim;
      c.scores["psnr_worst" + name] = scores[split.worst].score.psnr;
    }
    writeScores(c.folder, scores, trainingDownscale(c));
  }

  void mesh(StepContext& c) const {
    const GaussianCloud cloud = readSplatPly(c.input("surface.refine") / kCloudFile).cloud;
    const Mesh mesh = extractMesh(cloud, trainingCameras(c), options_.mesh, c.device, c.progress);
    writeMeshPly(c.folder / kMeshFile, mesh);
    c.scores["triangles"] = static_cast<double>(mesh.triangles.size());
  }

  // Nothing that is not a number gets onto the disk.
  static void keep(StepContext& c, const GaussianCloud& cloud) {
    if (cloud.size() == 0)
      throw Error(Error::Kind::Data, "no Gaussians are left; check masks and calibration");
    validate(cloud);
    writeSplatPly(c.folder / kCloudFile, cloud, nullptr);
    c.scores["gaussians"] = static_cast<double>(cloud.size());
  }
};

}  // namespace

std::unique_ptr<Stage> makeSurfaceStage() { return std::make_unique<SurfaceStage>(); }

}  // namespace beam
