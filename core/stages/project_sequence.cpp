// SPDX-License-Identifier: Apache-2.0
#include "core/stages/project_sequence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/method/follow_surface.h"
#include "core/method/interpolate_skin.h"
#include "core/stages/carried_skin.h"
#include "core/stages/frame_files.h"
#include "core/stages/result_files.h"
#include "core/stages/step_ids.h"
#include "core/stages/track_files.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

// The most finished first.
const std::array kFrameSteps = {kMaterialsStep, kRefineStep, kFitStep};

// The results of one frame that an interpolation reads.
struct SolvedFolders {
  fs::path skin, joints;
  std::optional<fs::path> materials;
  bool refined = false;
};
struct SolvedPair {
  SolvedFolders a, b;
  Between between;
};

GaussianFrame interpolated(const SolvedPair& pair) {
  const auto& [a, b, between] = pair;
  const bool materials = a.materials && b.materials;
  const auto read = [&](const SolvedFolders& s) {
    return readSplatPly(materials ? *s.materials / kMaterialsFile : s.skin / kCloudFile);
  };
  SplatFile from = read(a), to = read(b);
  GaussianFrame frame;
  frame.cloud = interpolateSkin(readCarriedSkin(std::move(from.cloud), a.skin, &a.joints),
                                readCarriedSkin(std::move(to.cloud), b.skin, &b.joints),
                                readPosePly(b.joints / kRestPoseFile), between.share);
  frame.refined = a.refined && b.refined;
  frame.interpolated = true;
  if (from.materials && to.materials)
    frame.materials = interpolateMaterials(*from.materials, *to.materials, between.share);
  return frame;
}

// Project works out keys in a memo of one thread: whoever asks it holds the mutex. Files are read without.
class ProjectSequence final : public GaussianSequence {
 public:
  ProjectSequence(const Project& project, Shows shows, std::shared_ptr<const TakeSurvey> survey)
      : project_(project),
        shows_(shows),
        survey_(std::move(survey)),
        labels_(labelled(project.capture().frames)),
        rate_(project.capture().frames_per_second),
        capture_from_world_(project.capture().capture_from_world) {
    for (const StageInfo& stage : project.setup().stages.infos()) {
      for (const StepInfo& step : stage.steps) steps_.insert(StepId(stage.id, step.id));
    }
  }

  std::string id() const override { return project_.folder().string(); }
  const std::vector<FrameLabel>& frames() const override { return labels_; }
  double rate() const override { return rate_; }
  Similarity3 captureFromWorld() const override { return capture_from_world_; }

  std::optional<Digest> stamp(FrameIndex frame) const override {
    if (survey_) return survey_->stamps[static_cast<std::size_t>(frame.value)];
    if (shows_ == Shows::Newest) return std::nullopt;
    const std::string own = keysOf(frame);
    if (!own.empty() || shows_ == Shows::Solved) return own.empty() ? Digest{} : digestOf(own);
    const std::optional<SolvedPair> pair = solvedPair(frame);
    if (!pair) return Digest{};
    return digestOf("between " + keysOf(pair->between.before) + keysOf(pair->between.after));
  }

  FrameContent content(FrameIndex frame) const override {
    FrameContent c;
    c.materials = isDone(kMaterialsStep, frame);
    const bool finished = c.materials || isDone(kRefineStep, frame);
    c.gaussians = finished || isDone(kFitStep, frame);
    c.unfinished = c.gaussians && !finished && isFor(kRefineStep, frame);
    c.mesh = isDone(kMeshStep, frame);
    if (!c.gaussians && shows_ != Shows::Solved) {
      if (const std::optional<SolvedPair> pair = solvedPair(frame)) {
        c.gaussians = c.interpolated = true;
        c.materials = pair->a.materials && pair->b.materials;
      }
    }
    for (const Leftover& l : leftovers(frame)) {
      c.gaussians |= l.step != kMeshStep;
      c.materials |= l.step == kMaterialsStep;
      c.mesh |= l.step == kMeshStep;
    }
    return c;
  }

  std::shared_ptr<const GaussianFrame> load(FrameIndex frame) const override {
    std::optional<GaussianFrame> found;
    const bool older = !leftovers(frame).empty() && !project_.withoutCapture();
    if (older && !result(kMaterialsStep, frame))
      found = readOlderMaterials(project_.store(), leftovers(frame), key(kRefineStep, frame));
    if (!found) found = own(frame);
    if (!found && shows_ != Shows::Solved) {
      if (const std::optional<SolvedPair> pair = solvedPair(frame)) found = interpolated(*pair);
    }
    if (!found) found = readLeftover(project_.store(), leftovers(frame));
    return found ? std::make_shared<const GaussianFrame>(std::move(*found)) : nullptr;
  }

  std::shared_ptr<const Mesh> mesh(FrameIndex frame) const override {
    const auto shared = [](Mesh&& m) { return std::make_shared<const Mesh>(std::move(m)); };
    if (const auto folder = result(kMeshStep, frame)) return shared(readMeshPly(*folder / kMeshFile));
    if (isSolved(frame) || solvedPair(frame)) return nullptr;  // what is left is of another surface
    std::optional<Mesh> left = readLeftoverMesh(project_.store(), leftovers(frame));
    return left ? shared(std::move(*left)) : nullptr;
  }

  std::optional<FrameIndex> before(FrameIndex frame) const override {
    if (const auto between = trackedAround(frame)) return between->before;
    std::lock_guard lock(mutex_);
    const Take take = project_.takeOf(frame);
    const std::optional<FrameIndex> earlier = take.before(frame);
    return earlier && project_.takeOf(*earlier) == take ? earlier : std::nullopt;
  }

  FrameJoints joints(FrameIndex frame) const override {
    if (const auto folder = result(kJointsStep, frame)) return readJoints(*folder);
    const std::optional<Between> between = trackedAround(frame);
    if (!between) return {};
    const auto a = result(kJointsStep, between->before), b = result(kJointsStep, between->after);
    if (!a || !b) return {};
    const FrameJoints from = readJoints(*a), to = readJoints(*b);
    if (to.restarted) return {};
    return {interpolateJoints(from.pose, to.pose, between->share), false, true};
  }

  std::optional<CarriedPose> carried(FrameIndex frame) const override {
    const auto joints = result(kJointsStep, frame);
    auto skin = result(kRefineStep, frame);
    if (!skin) skin = result(kFitStep, frame);
    if (!joints || !skin) return std::nullopt;
    return readCarriedPose(*skin, *joints);
  }

  std::optional<SequenceTake> take(FrameIndex frame) const override {
    const std::optional<Between> between = trackedAround(frame);
    const FrameIndex of = between ? between->after : frame;
    const auto joints = result(kJointsStep, of);
    if (!joints) return std::nullopt;
    const Take members = takeOf(of);
    SequenceTake take{members.begin(), {}, readPosePly(*joints / kRestPoseFile), {}};
    for (const FrameIndex f : members.claimed()) {
      const auto tracked = f == take.first ? std::nullopt : result(kJointsStep, f);
      if (tracked && readTrackNote(*tracked).restarted) take.restarts.push_back(f);
    }
    if (const auto pose = carried(of)) take.binding = boundTo(pose->rest_skin, take.rest_joints);
    return take;
  }

 private:
  // Empty: there are none, or they are not to be shown.
  const Leftovers& leftovers(FrameIndex frame) const {
    static const Leftovers kNone;
    const bool shown = shows_ == Shows::Newest && survey_;
    return shown ? survey_->leftovers[static_cast<std::size_t>(frame.value)] : kNone;
  }

  // A pipeline need not have every step of the house.
  std::optional<fs::path> result(const StepId& step, FrameIndex frame) const {
    if (!steps_.contains(step)) return std::nullopt;
    std::lock_guard lock(mutex_);
    return project_.result(step, frame);
  }
  Digest key(const StepId& step, FrameIndex frame) const {
    std::lock_guard lock(mutex_);
    return project_.key(step, frame);
  }
  bool isDone(const StepId& step, FrameIndex frame) const {
    if (!steps_.contains(step)) return false;
    std::lock_guard lock(mutex_);
    return project_.state(step, frame) == StepState::Done;
  }
  bool isFor(const StepId& step, FrameIndex frame) const {
    if (!steps_.contains(step)) return false;
    std::lock_guard lock(mutex_);
    return project_.applies(step, frame);
  }
  Take takeOf(FrameIndex frame) const {
    std::lock_guard lock(mutex_);
    return project_.takeOf(frame);
  }
  std::optional<Between> betweenOf(FrameIndex frame) const {
    std::lock_guard lock(mutex_);
    return beam::betweenOf(project_.takes(), frame);
  }
  // Keys of what there is of the frame itself.
  std::string keysOf(FrameIndex frame) const {
    std::string keys;
    for (const StepId& step : {kMaterialsStep, kRefineStep, kFitStep, kMeshStep}) {
      if (isDone(step, frame)) keys += key(step, frame).hex();
    }
    return keys;
  }

  bool isSolved(FrameIndex frame) const {
    for (const StepId& step : kFrameSteps) {
      if (result(step, frame)) return true;
    }
    return false;
  }
  std::optional<GaussianFrame> own(FrameIndex frame) const {
    for (const StepId& step : kFrameSteps) {
      if (const auto folder = result(step, frame)) return readFrame(step, *folder);
    }
    return std::nullopt;
  }

  std::optional<SolvedFolders> solvedAt(FrameIndex frame, const StepId& step) const {
    const auto skin = result(step, frame), joints = result(kJointsStep, frame);
    if (!skin || !joints) return std::nullopt;
    return SolvedFolders{*skin, *joints, result(kMaterialsStep, frame), step == kRefineStep};
  }
  // The frame has no result of its own and lies between two that are solved, both as far as both are.
  std::optional<SolvedPair> solvedPair(FrameIndex frame) const {
    const std::optional<Between> between = betweenOf(frame);
    if (!between || isSolved(frame)) return std::nullopt;
    for (const StepId& step : {kRefineStep, kFitStep}) {
      auto a = solvedAt(between->before, step), b = solvedAt(between->after, step);
      if (!a || !b) continue;
      if (!isCarried(b->skin)) return std::nullopt;
      return SolvedPair{std::move(*a), std::move(*b), *between};
    }
    return std::nullopt;
  }
  // Likewise of joints: it has none, and lies between two members of a take with a stride.
  std::optional<Between> trackedAround(FrameIndex frame) const {
    return result(kJointsStep, frame) ? std::nullopt : betweenOf(frame);
  }

  const Project project_;
  const Shows shows_;
  const std::shared_ptr<const TakeSurvey> survey_;
  const std::vector<FrameLabel> labels_;
  const double rate_;
  const Similarity3 capture_from_world_;
  std::set<StepId> steps_;
  mutable std::mutex mutex_;  // over what project_ remembers of keys
};

}  // namespace

std::shared_ptr<const GaussianSequence> sequenceOf(const Project& project, Shows shows,
                                                   std::shared_ptr<const TakeSurvey> survey) {
  return std::make_shared<const ProjectSequence>(project, shows, std::move(survey));
}

bool anySolved(const TakeSurvey& survey) {
  return std::any_of(kFrameSteps.begin(), kFrameSteps.end(), [&](const StepId& step) {
    const SurveyCurve* seconds = survey.curve(step.text() + ".seconds");  // of every finished one
    return seconds && std::any_of(seconds->values.begin(), seconds->values.end(),
                                  [](double v) { return !std::isnan(v); });
  });
}

}  // namespace beam
