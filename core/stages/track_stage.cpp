// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/base/log.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/math/statistics.h"
#include "core/method/seed_points.h"
#include "core/method/track_joints.h"
#include "core/scene/pose.h"
#include "core/stages/builtin_stages.h"
#include "core/stages/result_files.h"
#include "core/stages/step_ids.h"
#include "core/stages/track_files.h"
#include "core/stages/training_input.h"

namespace beam {
namespace {

constexpr const char* kBeforeFile = "before.ply";  // pose of the frame before: the velocity
constexpr double kSeedShare = 0.4;                 // seeds as a share of the joints; growth adds the rest

struct TrackOptions {
  TrackJointsOptions joints;
  double restart_ratio = 4;  // ours (methods 3.8: off in the paper's code)
  int segment_frames = 50;   // ours: what a fault or a second machine can repeat or take over
  int overlap = 4;           // ours: with 2 the seam is 0.3 dB below the uncut take, with 4 it is gone
};

void describe(Fields& f, TrackOptions& o) {
  describe(f, o.joints);
  f.field({.name = "restart_ratio",
           .label = "Restart threshold",
           .help = "Joints are fitted anew in a frame that they match this many times worse than after the "
                   "last start, as when a jacket comes off; 0 switches it off.",
           .min = 0,
           .max = 1000,
           .unit = "times"},
          o.restart_ratio);
  f.field({.name = "segment_frames",
           .label = "Frames per segment",
           .help = "A take is cut into segments of this length, each of which can run alone; 0: never cut.",
           .min = 0,
           .max = 1e6,
           .unit = "frames",
           .effect = Effect::LaterResults},
          o.segment_frames);
  f.field({.name = "overlap",
           .label = "Overlap of segments",
           .help = "Frames that a segment solves before its first, so that it does not begin with a frame "
                   "fitted alone, which holds less detail; 0: segments begin on their own.",
           .min = 0,
           .max = 100,
           .unit = "frames",
           .effect = Effect::LaterResults},
          o.overlap);
}

class TrackStage final : public StageOf<TrackOptions> {
 public:
  const StageInfo& info() const override {
    static const StageInfo kInfo{
        .id = "track",
        .title = "Track",
        .summary =
            "Follows coarse Gaussians, the joints, through a take; they carry the "
            "fine ones of every later frame.",
        .steps = {{.id = "joints",
                   .title = "Track joints",
                   .source = "BEAM 3.1, eq. 9",
                   .version = 2,
                   .reads = {Reads::Pictures},
                   .inputs = {kImportStep, kScreenStep},
                   .weight = 30,
                   .frames = Frames::InTakes,
                   .later = {.previous = {kJointsStep}},
                   .work = {.pixels = true,
                            .downscale = kDownscale,
                            .times = "track.first_iterations",
                            .later_times = "track.iterations"},
                   .memory = {.raise = {kDownscale}}}},
        .takes = {.segment_frames = "track.segment_frames", .overlap = "track.overlap"}};
    return kInfo;
  }

  void run(std::string_view, StepContext& c) const override {
    const LentViews lent = trainingViews(c);
    const std::vector<FrameView>& views = lent.all();
    if (!c.later()) return start(c, views, false);
    const std::filesystem::path& before = *c.previousResult(kJointsStep);
    const TrackNote note = readTrackNote(before);
    const GaussianCloud previous = readSplatPly(before / kJointsFile).cloud;
    const TrackedJoints tracked = follow(c, views, before, previous);
    const double limit = options_.restart_ratio * note.reference_residual;
    if (limit > 0 && tracked.residual > limit) {
      logWarning(
          "frame {}: the joints fit {:.1f} times worse than after the last start; they start anew here",
          c.capture.frames[static_cast<std::size_t>(c.frame.value)],
          tracked.residual / note.reference_residual);
      return start(c, views, true);
    }
    writeSplatPly(c.folder / kJointsFile, tracked.joints, nullptr);
    writePosePly(c.folder / kRestPoseFile, readPosePly(before / kRestPoseFile));
    writePosePly(c.folder / kBeforeFile, poseOf(previous));
    c.scores["motion_p95_m"] = motionOf(previous.position_m, tracked.joints.position_m);
    c.scores["residual"] = tracked.residual;
    c.scores["e_rigid"] = tracked.rigid;
    writeTrackNote(c.folder,
                   {false, note.reference_residual > 0 ? note.reference_residual : tracked.residual});
  }

 private:
  void start(StepContext& c, const std::vector<FrameView>& views, bool again) const {
    Progress seeding = c.progress.part(0.1, "seeding");
    const int count = std::max(100, static_cast<int>(kSeedShare * options_.joints.joints));
    const PointCloud seeds = seedPoints(views, c.capture.seed_points, count, options_.joints.seed, seeding);
    Progress fitting = c.progress.part(0.9, "first joints");
    const GaussianCloud joints = fitFirstJoints(views, seeds, options_.joints, c.device, fitting, c.preview);
    writeSplatPly(c.folder / kJointsFile, joints, nullptr);
    writePosePly(c.folder / kRestPoseFile, poseOf(joints));
    c.scores["residual"] = jointResidual(views, joints, options_.joints.mask_weight, c.device, c.progress);
    c.scores["restart"] = again ? 1 : 0;
    c.scores["joints"] = static_cast<double>(joints.size());
    writeTrackNote(c.folder, {again, 0});
  }

  TrackedJoints follow(StepContext& c, const std::vector<FrameView>& views,
                       const std::filesystem::path& before, const GaussianCloud& previous) const {
    const Pose rest = readPosePly(before / kRestPoseFile);
    std::vector<vec3> earlier;
    if (std::filesystem::exists(before / kBeforeFile)) earlier = readPosePly(before / kBeforeFile).position_m;
    TrackedJoints tracked =
        trackJoints(views, {rest, previous, earlier}, options_.joints, c.device, c.progress, c.preview);
    validate(tracked.joints);
    return tracked;
  }

  // 95th percentile, metres.
  static double motionOf(std::span<const vec3> from, std::span<const vec3> to) {
    std::vector<float> moved(from.size());
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = glm::length(to[i] - from[i]);
    return quantile(std::move(moved), 0.95);
  }
};

}  // namespace

std::unique_ptr<Stage> makeTrackStage() { return std::make_unique<TrackStage>(); }

}  // namespace beam
