// SPDX-License-Identifier: Apache-2.0
#include "core/stages/interpolated_frame.h"

#include <utility>

#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/method/interpolate_skin.h"
#include "core/stages/carried_skin.h"
#include "core/stages/track_files.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJoints = "track.joints";

// The results of one frame that an interpolation reads.
struct Solved {
  fs::path skin, joints;
  std::optional<fs::path> materials;
  bool refined = false;
};

std::optional<Solved> solvedAt(const Project& project, FrameIndex frame, const char* step) {
  const auto skin = project.result(step, frame), joints = project.result(kJoints, frame);
  if (!skin || !joints) return std::nullopt;
  return Solved{*skin, *joints, project.result(kMaterialsStep, frame), step == kRefineStep};
}

// Both as far as both are solved.
std::optional<std::pair<Solved, Solved>> solvedPair(const Project& project, const Between& between) {
  for (const char* step : {kRefineStep, kFitStep}) {
    auto a = solvedAt(project, between.before, step), b = solvedAt(project, between.after, step);
    if (!a || !b) continue;
    if (!isCarried(b->skin)) return std::nullopt;
    return std::pair(std::move(*a), std::move(*b));
  }
  return std::nullopt;
}

FrameResult interpolated(const Solved& a, const Solved& b, double share) {
  const bool materials = a.materials && b.materials;
  const auto read = [&](const Solved& s) {
    return readSplatPly(materials ? *s.materials / kMaterialsFile : s.skin / kCloudFile);
  };
  SplatFile from = read(a), to = read(b);
  FrameResult out{.cloud = interpolateSkin(readCarriedSkin(std::move(from.cloud), a.skin, &a.joints),
                                           readCarriedSkin(std::move(to.cloud), b.skin, &b.joints),
                                           readPosePly(b.joints / kRestPoseFile), share),
                  .materials = std::nullopt,
                  .refined = a.refined && b.refined,
                  .interpolated = true};
  if (from.materials && to.materials)
    out.materials = interpolateMaterials(*from.materials, *to.materials, share);
  return out;
}

}  // namespace

std::optional<FrameResult> loadShownFrame(const Project& project, FrameIndex frame) {
  if (auto own = loadFrameResult(project, frame)) return own;
  const std::optional<Between> between = betweenOf(project.takes(), frame);
  if (!between) return std::nullopt;
  const auto pair = solvedPair(project, *between);
  if (!pair) return std::nullopt;
  return interpolated(pair->first, pair->second, between->share);
}

std::optional<FrameResult> loadShownFrame(const Project& project, FrameIndex frame,
                                          const Leftovers& leftovers) {
  if (project.withoutCapture()) return loadLeftover(project, leftovers);
  if (!project.result(kMaterialsStep, frame)) {
    if (auto older = loadOlderMaterials(project, frame, leftovers)) return older;
  }
  if (auto shown = loadShownFrame(project, frame)) return shown;
  return loadLeftover(project, leftovers);
}

std::optional<Mesh> loadShownMesh(const Project& project, FrameIndex frame, const Leftovers& leftovers) {
  if (project.withoutCapture()) return loadLeftoverMesh(project, leftovers);
  if (auto mesh = loadFrameMesh(project, frame)) return mesh;
  for (const char* step : {kMaterialsStep, kRefineStep, kFitStep}) {
    if (project.result(step, frame)) return std::nullopt;
  }
  if (solvedAround(project, frame)) return std::nullopt;
  return loadLeftoverMesh(project, leftovers);
}

std::optional<Pose> jointsBetween(const Project& project, const Between& between) {
  const auto a = project.result(kJoints, between.before), b = project.result(kJoints, between.after);
  if (!a || !b || readTrackNote(*b).restarted) return std::nullopt;
  const auto read = [](const fs::path& folder) { return poseOf(readSplatPly(folder / kJointsFile).cloud); };
  return interpolateJoints(read(*a), read(*b), between.share);
}

std::optional<Between> solvedAround(const Project& project, FrameIndex frame) {
  for (const char* step : {kMaterialsStep, kRefineStep, kFitStep}) {
    if (project.result(step, frame)) return std::nullopt;
  }
  const std::optional<Between> between = betweenOf(project.takes(), frame);
  return between && solvedPair(project, *between) ? between : std::nullopt;
}

}  // namespace beam
