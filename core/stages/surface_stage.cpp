// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/method/evaluate_motion.h"
#include "core/method/extract_mesh.h"
#include "core/method/fit_surface.h"
#include "core/method/follow_surface.h"
#include "core/method/score_views.h"
#include "core/method/seed_points.h"
#include "core/scene/pose.h"
#include "core/stages/builtin_stages.h"
#include "core/stages/carried_skin.h"
#include "core/stages/result_files.h"
#include "core/stages/score_files.h"
#include "core/stages/step_ids.h"
#include "core/stages/track_files.h"
#include "core/stages/training_input.h"

namespace beam {
namespace {

struct SurfaceOptions {
  FitSurfaceOptions fit;
  FollowSurfaceOptions later;
  ExtractMeshOptions mesh;
};

void describe(Fields& fields, SurfaceOptions& options) {
  describe(fields, options.fit);
  fields.group("later", [&] { describe(fields, options.later); });
  fields.group("mesh", [&] { describe(fields, options.mesh); });
}

class SurfaceStage final : public StageOf<SurfaceOptions> {
 public:
  const StageInfo& info() const override {
    static const StepWork kFitWork{.pixels = true,
                                   .downscale = kDownscale,
                                   .times = "surface.iterations",
                                   .later_times = "surface.later.iterations"};
    static const StepMemory kFitMemory{.raise = {kDownscale}, .lower = {"surface.cap"}};
    static const StageInfo kInfo{
        .id = "surface",
        .title = "Surface",
        .summary =
            "Fits Gaussians to the photographs, carries them from frame to frame, fuses a mesh from them.",
        .steps = {{.id = "seed",
                   .title = "Seed points",
                   .source = "BEAM 3.1",
                   .reads = {Reads::Pictures},
                   .inputs = {kImportStep, kScreenStep},
                   .weight = 1,
                   .frames = Frames::FirstOfTake,
                   .work = {.photographs = true},
                   .memory = {.raise = {kDownscale}}},
                  {.id = "fit",
                   .title = "Fit appearance",
                   .source = "BEAM 3.1, eq. 8",
                   .version = 2,
                   .reads = {Reads::Pictures},
                   .inputs = {kImportStep, kScreenStep, kSeedStep},
                   .weight = 45,
                   .later = {.inputs = {kJointsStep}, .previous = {kJointsStep, kRefineStep}},
                   .work = kFitWork,
                   .memory = kFitMemory,
                   .shown = {.frame = true}},
                  {.id = "refine",
                   .title = "Refine geometry",
                   .source = "BEAM 3.1, E_normal",
                   .reads = {Reads::Pictures},
                   .inputs = {kImportStep, kScreenStep, kFitStep},
                   .weight = 45,
                   .later = {.inputs = {kJointsStep}, .previous = {kRefineStep}},
                   .work = kFitWork,
                   .memory = kFitMemory,
                   .shown = {.frame = true, .surface = kRefineStep}},
                  {.id = "score",
                   .title = "Score against the photographs",
                   .reads = {Reads::Pictures, Reads::HeldOut},
                   .inputs = {kImportStep, kScreenStep, kRefineStep},
                   .weight = 2,
                   .later = {.previous = {kRefineStep}},
                   .work = {.photographs = true, .pixels = true, .downscale = kDownscale},
                   .memory = {.raise = {kDownscale}}},
                  {.id = "mesh",
                   .title = "Fuse a mesh",
                   .unmasked_version = 1,
                   .inputs = {kImportStep, kScreenStep, kRefineStep},
                   .weight = 4,
                   .work = {.photographs = true, .pixels = true, .downscale = kDownscale},
                   .memory = {.raise = {"surface.mesh.voxel_m", kDownscale}},
                   .shown = {.frame = true, .surface = kRefineStep}}}};
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
    const LentViews lent = trainingViews(c);
    const PointCloud seeds =
        seedPoints(lent.all(), c.capture.seed_points, seedCount(), options_.fit.seed, c.progress);
    writePointsPly(c.folder / kSeedsFile, seeds);
    c.scores["points"] = static_cast<double>(seeds.position_m.size());
  }

  int seedCount() const { return static_cast<int>(options_.fit.seed_share * options_.fit.cap); }

  void fit(StepContext& c) const {
    const LentViews lent = trainingViews(c);
    const std::vector<FrameView>& views = lent.all();
    if (!c.later()) {
      const PointCloud seeds = readPointsPly(c.input(kSeedStep) / kSeedsFile);
      return keep(c, fitAppearance(views, seeds, options_.fit, c.device, c.progress, c.preview),
                  seeds.position_m.size());
    }
    if (restarted(c)) return fitAnew(c, views);
    const Carried in = carried(c);
    const Pose tracked_before = poseOf(readSplatPly(*c.previousResult(kJointsStep) / kJointsFile).cloud);
    const Pose tracked = poseOf(readSplatPly(c.input(kJointsStep) / kJointsFile).cloud);
    const Pose start = carriedJoints(tracked_before, in.previous.joints, tracked);
    keepSkin(c, followAppearance(views, {in.previous, in.rest_joints, start}, options_.fit, options_.later,
                                 c.device, c.progress, c.preview));
  }

  void refine(StepContext& c) const {
    const LentViews lent = trainingViews(c);
    const std::vector<FrameView>& views = lent.all();
    const std::filesystem::path& fitted = c.input(kFitStep);
    GaussianCloud cloud = readSplatPly(fitted / kCloudFile).cloud;
    if (!c.later() || restarted(c)) {
      return keep(c, refineGeometry(views, cloud, options_.fit, c.device, c.progress, c.preview),
                  cloud.size());
    }
    const Carried in = carried(c);
    const CarriedSkin start{std::move(cloud), readPosePly(fitted / kRestPoseFile),
                            readPosePly(fitted / kJointPoseFile)};
    keepSkin(c, followGeometry(views, {in.previous, in.rest_joints, start.joints}, start, options_.fit,
                               options_.later, c.device, c.progress, c.preview));
  }

  static bool restarted(const StepContext& c) { return readTrackNote(c.input(kJointsStep)).restarted; }

  // Nothing of the frame before fits here: a first frame in the middle of a take.
  void fitAnew(StepContext& c, const std::vector<FrameView>& views) const {
    Progress seeding = c.progress.part(0.05, "seeding"), fitting = c.progress.part(0.95, "fitting");
    const PointCloud seeds =
        seedPoints(views, c.capture.seed_points, seedCount(), options_.fit.seed, seeding);
    keep(c, fitAppearance(views, seeds, options_.fit, c.device, fitting, c.preview), seeds.position_m.size());
  }

  struct Carried {
    CarriedSkin previous;  // refine does not see the joints of a first frame: empty
    Pose rest_joints;
  };

  static Carried carried(const StepContext& c) {
    const std::filesystem::path& before = *c.previousResult(kRefineStep);
    return {readCarriedSkin(readSplatPly(before / kCloudFile).cloud, before, c.previousResult(kJointsStep)),
            readPosePly(c.input(kJointsStep) / kRestPoseFile)};
  }

  // At the resolution of the fit; `beam evaluate` scores the whole pictures.
  void score(StepContext& c) const {
    const GaussianCloud cloud = readSplatPly(c.input(kRefineStep) / kCloudFile).cloud;
    std::vector<ViewScore> scores;
    for (const bool held_out : {false, true}) {
      Progress part = c.progress.part(0.48, held_out ? "held-out views" : "training views");
      const LentViews lent = held_out ? heldOutViews(c) : trainingViews(c);
      const std::vector<FrameView>& views = lent.all();
      for (ViewScore& s : scoreViews(views, held_out, cloud, c.device, part)) scores.push_back(std::move(s));
      const SplitScore split = meanOf(scores, held_out);
      if (split.n == 0) continue;
      const std::string name = held_out ? "_test" : "_train";
      c.scores["psnr" + name] = split.mean.psnr;
      if (split.mean.ssim) c.scores["ssim" + name] = *split.mean.ssim;
      c.scores["psnr_worst" + name] = scores[split.worst].score.psnr;
    }
    Progress part = c.progress.part(0.04, "views left out of the fit");
    const LentViews left_out = leftOutViews(c);
    for (ViewScore& s : scoreViews(left_out.all(), false, cloud, c.device, part)) {
      s.left_out = true;
      scores.push_back(std::move(s));
    }
    writeScores(c.folder, scores, trainingDownscale(c));
    if (!c.later()) return;
    const GaussianCloud before = readSplatPly(*c.previousResult(kRefineStep) / kCloudFile).cloud;
    if (isTracked(before, cloud)) c.scores["flicker_radiance"] = radianceFlicker(before, cloud);
  }

  void mesh(StepContext& c) const {
    const GaussianCloud cloud = readSplatPly(c.input(kRefineStep) / kCloudFile).cloud;
    const MeshScope scope{.scene = c.capture.masks == MaskKind::None, .most_rows = kMostPlyRows};
    Progress fusing = c.progress.part(0.95, {});
    const ExtractedMesh made =
        extractMesh(cloud, trainingCameras(c), options_.mesh, scope, c.device, fusing, c.checkpoint);
    if (made.reached) logWarning("surface.mesh: {}", limitText(made, scope));
    if (scope.scene) logInfo("surface.mesh: voxels of {:.3g} m", made.voxel_m);
    const Progress writing = c.progress.part(0.05, "writing the mesh");
    writeMeshPly(c.folder / kMeshFile, made.mesh, {.progress = &writing});
    c.scores["triangles"] = static_cast<double>(made.mesh.triangles.size());
  }

  std::string limitText(const ExtractedMesh& made, const MeshScope& scope) const {
    const ExtractMeshOptions& o = options_.mesh;
    const int most_voxels = mostVoxels(o, scope);
    const bool rows = made.reached == MeshLimit::Rows;
    const std::string asked =
        fmt::format("voxels of {} m (surface.mesh.voxel_m){}", o.voxel_m,
                    scope.scene ? fmt::format(", in proportion to the scene {:.3g} m,", made.asked_m) : "");
    const std::string limit =
        rows ? fmt::format("more triangles than the limit of {} of a mesh file", scope.most_rows)
             : fmt::format("more voxels near surfaces than the limit of {} (surface.mesh.most_voxels)",
                           most_voxels);
    return fmt::format("{} would make {}: voxels of {:.3g} m are used; raise {}", asked, limit, made.voxel_m,
                       rows || most_voxels == kMostVoxels ? "surface.mesh.voxel_m to choose their size"
                                                          : "the limit for finer ones");
  }

  // Nothing that is not a number gets onto the disk.
  static void keep(StepContext& c, const GaussianCloud& cloud, std::size_t before) {
    if (cloud.size() == 0) {
      throw Error(
          Error::Kind::Data,
          fmt::format("none of {} Gaussians is left in frame {}: check its masks and the calibration, "
                      "which say that there is nothing where the cameras look; where both are right, "
                      "raise surface.iterations or surface.cap",
                      before, c.capture.frames[static_cast<std::size_t>(c.frame.value)]));
    }
    validate(cloud);
    writeSplatPly(c.folder / kCloudFile, cloud, nullptr);
    c.scores["gaussians"] = static_cast<double>(cloud.size());
  }

  static void keepSkin(StepContext& c, const FollowedSkin& skin) {
    keep(c, skin.cloud, skin.rest_skin.size());
    writePosePly(c.folder / kRestPoseFile, skin.rest_skin);
    writePosePly(c.folder / kJointPoseFile, skin.joints);
    c.scores["e_smooth"] = skin.smooth_m2;
    c.scores["e_temp"] = skin.temporal;
  }
};

}  // namespace

std::unique_ptr<Stage> makeSurfaceStage() { return std::make_unique<SurfaceStage>(); }

}  // namespace beam
