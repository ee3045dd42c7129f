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
#include "core/io/visibility_ply.h"
#include "core/method/follow_surface.h"
#include "core/method/interpolate_skin.h"
#include "core/scene/thin_axis.h"
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
  std::optional<fs::path> visibility = {};
};
// A frame between two members of a take.
struct Around {
  Take take;
  Between between;
};
struct SolvedPair {
  SolvedFolders a, b;
  Take take;
  Between between;
};

GaussianFrame interpolated(const SolvedPair& pair) {
  const auto& [a, b, take, between] = pair;
  const bool materials = a.materials && b.materials;
  const auto read = [&](const SolvedFolders& s) {
    return readSplatPly(materials ? *s.materials / kMaterialsFile : s.skin / kCloudFile);
  };
  SplatFile from = read(a), to = read(b);
  const std::vector<vec3> axes = thinAxes(from.cloud);
  GaussianFrame frame;
  frame.cloud = interpolateSkin(readCarriedSkin(std::move(from.cloud), a.skin, &a.joints),
                                readCarriedSkin(std::move(to.cloud), b.skin, &b.joints),
                                readPosePly(b.joints / kRestPoseFile), between.share);
  frame.refined = a.refined && b.refined;
  frame.interpolated = true;
  if (from.materials && to.materials)
    frame.materials = interpolateMaterials(*from.materials, *to.materials, between.share);
  if (a.visibility && b.visibility) {
    VisibilityFile visibility = readVisibilityPly(*a.visibility / kVisibilityFile);
    visibility.visibility = interpolateSh(
        visibility.visibility, readVisibilityPly(*b.visibility / kVisibilityFile).visibility, between.share);
    addVisibility(std::move(visibility), axes, *a.visibility, frame);
  }
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
        capture_from_world_(project.capture().capture_from_world),
        takes_(project.takes()),
        layers_(project.earlierTakes()) {
    layers_.insert(layers_.end(), takes_.begin(), takes_.end());
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
    return digestOf("between " + keysIn(pair->take, pair->between.before) +
                    keysIn(pair->take, pair->between.after));
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
    if (found) addVisibilityOf(frame, *found);
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
    if (const auto around = trackedAround(frame)) return around->between.before;
    const Take take = takeOf(frame);
    const std::optional<FrameIndex> earlier = take.before(frame);
    return earlier && takeOf(*earlier) == take ? earlier : std::nullopt;
  }

  FrameJoints joints(FrameIndex frame) const override {
    if (const auto folder = result(kJointsStep, frame)) return readJoints(*folder);
    const std::optional<Around> around = trackedAround(frame);
    if (!around) return {};
    const auto a = resultIn(around->take, kJointsStep, around->between.before),
               b = resultIn(around->take, kJointsStep, around->between.after);
    if (!a || !b) return {};
    const FrameJoints from = readJoints(*a), to = readJoints(*b);
    if (to.restarted) return {};
    return {interpolateJoints(from.pose, to.pose, around->between.share), false, true};
  }

  std::optional<CarriedPose> carried(FrameIndex frame) const override {
    const auto joints = result(kJointsStep, frame);
    auto skin = result(kRefineStep, frame);
    if (!skin) skin = result(kFitStep, frame);
    if (!joints || !skin) return std::nullopt;
    return readCarriedPose(*skin, *joints);
  }

  std::optional<SequenceTake> take(FrameIndex frame) const override {
    const std::optional<Around> around = trackedAround(frame);
    const FrameIndex of = around ? around->between.after : frame;
    const Take members = around ? around->take : takeOf(of);
    const auto joints = resultIn(members, kJointsStep, of);
    if (!joints) return std::nullopt;
    SequenceTake take{members.begin(), {}, readPosePly(*joints / kRestPoseFile), {}};
    for (const FrameIndex f : members.claimed()) {
      const auto tracked = f == take.first ? std::nullopt : resultIn(members, kJointsStep, f);
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

  bool hasStep(const StepId& step) const { return project_.setup().stages.has(step); }
  std::optional<fs::path> resultIn(const Take& take, const StepId& step, FrameIndex frame) const {
    if (!hasStep(step)) return std::nullopt;
    std::lock_guard lock(mutex_);
    return project_.result(step, take, frame);
  }
  std::optional<fs::path> result(const StepId& step, FrameIndex frame) const {
    return hasStep(step) ? resultIn(takeOf(frame), step, frame) : std::nullopt;
  }
  Digest key(const StepId& step, FrameIndex frame) const {
    const Take take = takeOf(frame);
    std::lock_guard lock(mutex_);
    return project_.key(step, take, frame);
  }
  bool isDoneIn(const Take& take, const StepId& step, FrameIndex frame) const {
    if (!hasStep(step)) return false;
    std::lock_guard lock(mutex_);
    return project_.state(step, take, frame) == StepState::Done;
  }
  bool isDone(const StepId& step, FrameIndex frame) const {
    return hasStep(step) && isDoneIn(takeOf(frame), step, frame);
  }
  bool isFor(const StepId& step, FrameIndex frame) const {
    return hasStep(step) && applies(project_.setup().stages.step(step), takeOf(frame), frame);
  }
  Take ownerOf(FrameIndex frame) const {
    std::lock_guard lock(mutex_);
    return project_.takeOf(frame);
  }
  // Of kFrameSteps, the first that there is; their number: none.
  std::size_t rankIn(const Take& take, FrameIndex frame) const {
    const auto first = std::find_if(kFrameSteps.begin(), kFrameSteps.end(),
                                    [&](const StepId& step) { return isDoneIn(take, step, frame); });
    return static_cast<std::size_t>(first - kFrameSteps.begin());
  }
  // The one that the frame is looked at in: its owner or, while it is further there, another that claims it.
  Take takeOf(FrameIndex frame) const {
    Take best = ownerOf(frame);
    const auto claims = [&](const Take& take) { return take.claims(frame) && take != best; };
    if (std::none_of(layers_.begin(), layers_.end(), claims)) return best;
    std::size_t rank = rankIn(best, frame);
    for (auto take = layers_.rbegin(); take != layers_.rend(); ++take) {
      if (rank == 0 || !claims(*take)) continue;
      if (const std::size_t there = rankIn(*take, frame); there < rank) best = *take, rank = there;
    }
    return best;
  }
  // Takes with a stride in which the frame lies between two members, the one that holds first.
  std::vector<Around> aroundsOf(FrameIndex frame) const {
    std::vector<Around> all;
    if (const std::optional<Between> between = betweenOf(takes_, frame))
      all.push_back({ownerOf(between->before), *between});
    for (auto take = layers_.rbegin(); take != layers_.rend(); ++take)
      if (const std::optional<Between> between = betweenOf(*take, frame)) all.push_back({*take, *between});
    return all;
  }
  // Keys of what there is of the frame.
  std::string keysIn(const Take& take, FrameIndex frame) const {
    std::string keys;
    for (const StepId& step : {kMaterialsStep, kVisibilityStep, kRefineStep, kFitStep, kMeshStep}) {
      if (!isDoneIn(take, step, frame)) continue;
      std::lock_guard lock(mutex_);
      keys += project_.key(step, take, frame).hex();
    }
    return keys;
  }
  std::string keysOf(FrameIndex frame) const { return keysIn(takeOf(frame), frame); }

  bool isSolved(FrameIndex frame) const {
    for (const StepId& step : kFrameSteps) {
      if (result(step, frame)) return true;
    }
    return false;
  }
  // Where there is some of its surface.
  void addVisibilityOf(FrameIndex frame, GaussianFrame& found) const {
    if (!found.refined) return;
    if (const auto folder = result(kVisibilityStep, frame))
      addVisibility(readVisibilityPly(*folder / kVisibilityFile), thinAxes(found.cloud), *folder, found);
  }
  std::optional<GaussianFrame> own(FrameIndex frame) const {
    for (const StepId& step : kFrameSteps) {
      const auto folder = result(step, frame);
      if (!folder) continue;
      GaussianFrame found = readFrame(step, *folder);
      addVisibilityOf(frame, found);
      return found;
    }
    return std::nullopt;
  }

  std::optional<SolvedFolders> solvedAt(const Take& take, FrameIndex frame, const StepId& step) const {
    const auto skin = resultIn(take, step, frame), joints = resultIn(take, kJointsStep, frame);
    if (!skin || !joints) return std::nullopt;
    const bool refined = step == kRefineStep;
    return SolvedFolders{*skin, *joints, resultIn(take, kMaterialsStep, frame), refined,
                         refined ? resultIn(take, kVisibilityStep, frame) : std::nullopt};
  }
  // The frame has no result of its own and lies between two that are solved, both as far as both are.
  std::optional<SolvedPair> solvedPair(FrameIndex frame) const {
    const std::vector<Around> arounds = aroundsOf(frame);
    if (arounds.empty() || isSolved(frame)) return std::nullopt;
    for (const auto& [take, between] : arounds) {
      for (const StepId& step : {kRefineStep, kFitStep}) {
        auto a = solvedAt(take, between.before, step), b = solvedAt(take, between.after, step);
        if (!a || !b) continue;
        if (!isCarried(b->skin)) return std::nullopt;
        return SolvedPair{std::move(*a), std::move(*b), take, between};
      }
    }
    return std::nullopt;
  }
  // Likewise of joints: it has none, and lies between two members of a take with a stride.
  std::optional<Around> trackedAround(FrameIndex frame) const {
    if (result(kJointsStep, frame)) return std::nullopt;
    const std::vector<Around> arounds = aroundsOf(frame);
    const auto tracked = std::find_if(arounds.begin(), arounds.end(), [&](const Around& a) {
      return isDoneIn(a.take, kJointsStep, a.between.before) &&
             isDoneIn(a.take, kJointsStep, a.between.after);
    });
    if (tracked != arounds.end()) return *tracked;
    return arounds.empty() ? std::nullopt : std::optional(arounds.front());
  }

  const Project project_;
  const Shows shows_;
  const std::shared_ptr<const TakeSurvey> survey_;
  const std::vector<FrameLabel> labels_;
  const double rate_;
  const Similarity3 capture_from_world_;
  const std::vector<Take> takes_;
  std::vector<Take> layers_;  // earlier takes, then those of now
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
