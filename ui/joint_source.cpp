// SPDX-License-Identifier: Apache-2.0
#include "ui/joint_source.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/stages/carried_skin.h"
#include "core/stages/interpolated_frame.h"
#include "core/stages/track_files.h"

namespace beam {
namespace {

constexpr const char* kTrackStage = "track";
constexpr const char* kJointsStep = "track.joints";
constexpr int kTrailFrames = 16;

const SurveyLane* trackLane(const TakeSurvey& survey) {
  const auto found = std::find_if(survey.lanes.begin(), survey.lanes.end(),
                                  [](const SurveyLane& lane) { return lane.stage == kTrackStage; });
  return found == survey.lanes.end() ? nullptr : &*found;
}

struct FrameJoints {
  JointPositions position_m;       // empty: the frame has none
  bool restarted = false;          // they are others than those of the frame before
  std::optional<Between> between;  // that they are interpolated from
};

FrameJoints readJoints(const Project& project, FrameIndex frame) {
  if (const auto folder = project.result(kJointsStep, frame))
    return {readSplatPly(*folder / kJointsFile).cloud.position_m, readTrackNote(*folder).restarted, {}};
  const std::optional<Between> between = betweenOf(project.takes(), frame);
  auto pose = between ? jointsBetween(project, *between) : std::nullopt;
  if (!pose) return {};
  return {std::move(pose->position_m), false, between};
}

// What the skin hangs on in a solved frame; null where its results are not those of `cloud`.
std::shared_ptr<const Anchors> readBinding(const Project& project, FrameIndex frame,
                                           const GaussianCloud& cloud) {
  const auto joints = project.result(kJointsStep, frame);
  auto folder = project.result("surface.refine", frame);
  if (!folder) folder = project.result("surface.fit", frame);
  if (!joints || !folder) return nullptr;
  const CarriedSkin skin = readCarriedSkin(cloud, *folder, nullptr);
  if (skin.rest_skin.size() != cloud.size()) return nullptr;
  return std::make_shared<const Anchors>(boundTo(skin.rest_skin, readPosePly(*joints / kRestPoseFile)));
}

}  // namespace

std::vector<float> influenceOf(const Anchors& anchors, std::uint32_t joint) {
  std::vector<float> shares(anchors.points(), 0.0f);
  for (std::size_t i = 0; i < anchors.target.size(); ++i) {
    if (anchors.target[i] == joint) shares[i / anchors.per_point] = anchors.weight[i];
  }
  return shares;
}

struct JointSource::Wish {
  Project project;
  std::shared_ptr<const TakeSurvey> survey;
  FrameIndex frame;
  int picked = -1;
  std::shared_ptr<const GaussianCloud> cloud;  // of the frame
};

struct JointSource::Memory {
  // Of one survey, so that its keys are worked out once: each holds those of all frames before.
  std::shared_ptr<const TakeSurvey> survey;
  std::optional<Project> project;
  std::map<std::int32_t, std::pair<Digest, FrameJoints>> joints;  // by frame, with the survey's stamp
  std::shared_ptr<const GaussianCloud> bound_cloud;
  std::shared_ptr<const Anchors> bound;
  std::shared_ptr<const std::vector<float>> influence;  // told last, of `picked`
  int picked = -1;
};

JointSource::JointSource(const ProjectModel& model, QObject* parent)
    : QObject(parent), model_(model), memory_(std::make_shared<Memory>()) {}

JointsShown JointSource::trailsAt(const Wish& wish, Memory& memory) {
  JointsShown shown;
  const SurveyLane* lane = trackLane(*wish.survey);
  if (!lane) return shown;  // this program tracks nothing
  if (memory.survey != wish.survey) {
    memory.survey = wish.survey;
    memory.project = wish.project;
  }
  const Project& project = *memory.project;
  const auto jointsOf = [&](FrameIndex f) -> const FrameJoints& {
    const Digest stamp = wish.survey->stamps[f.value];
    auto known = memory.joints.find(f.value);
    if (known == memory.joints.end() || known->second.first != stamp)
      known = memory.joints.insert_or_assign(f.value, std::pair(stamp, readJoints(project, f))).first;
    return known->second.second;
  };
  const FrameJoints& now = jointsOf(wish.frame);
  if (now.position_m.empty()) {
    shown.hint = "no joints of this frame yet: run until " + QString::fromStdString(lane->title);
    return shown;
  }
  std::optional<FrameIndex> at = wish.frame;
  if (now.between) {
    shown.trails.push_back(now.position_m);
    at = now.between->before;
  }
  const Take take = project.takeOf(*at);
  while (at && project.takeOf(*at) == take && shown.trails.size() < kTrailFrames) {
    const FrameJoints& joints = jointsOf(*at);
    if (joints.position_m.size() != now.position_m.size()) break;
    shown.trails.push_back(joints.position_m);
    at = joints.restarted ? std::nullopt : take.before(*at);
  }
  std::reverse(shown.trails.begin(), shown.trails.end());
  std::erase_if(memory.joints, [&](const auto& known) {
    return std::abs(known.first - wish.frame.value) > kTrailFrames * take.step;
  });
  return shown;
}

std::shared_ptr<const std::vector<float>> JointSource::influenceAt(const Wish& wish, Memory& memory) {
  if (memory.bound_cloud != wish.cloud) {
    const std::optional<Between>& between = memory.joints.at(wish.frame.value).second.between;
    memory.bound = readBinding(*memory.project, between ? between->after : wish.frame, *wish.cloud);
    memory.bound_cloud = wish.cloud;
  }
  memory.picked = wish.picked;
  memory.influence = memory.bound
                         ? std::make_shared<const std::vector<float>>(influenceOf(*memory.bound, wish.picked))
                         : nullptr;
  return memory.influence;
}

void JointSource::pick(int joint) {
  picked_ = joint;
  refresh();
}

void JointSource::refresh() {
  if (!model_.isOpen() || !model_.survey()) {
    seen_ = ++ticket_;
    shown_ = {};
    Q_EMIT changed();
    return;
  }
  const std::uint64_t ticket = ++ticket_;
  const Wish wish{model_.project(), model_.survey(), model_.frame(), picked_, model_.values().cloud};
  worker_.submit([this, wish, ticket, memory = memory_] {
    JointsShown shown;
    const auto tell = [&](bool last) {
      QMetaObject::invokeMethod(
          this,
          [this, shown, ticket, last] {
            if (ticket != ticket_) return;
            if (last) seen_ = ticket;
            shown_ = shown;
            Q_EMIT changed();
          },
          Qt::QueuedConnection);
    };
    try {
      shown = trailsAt(wish, *memory);
      const int joints = shown.trails.empty() ? 0 : static_cast<int>(shown.trails.back().size());
      if (wish.cloud && wish.picked >= 0 && wish.picked < joints) {
        // Binding takes its time on a large skin: until then that of the frame before stays.
        const bool same = memory->picked == wish.picked && memory->influence &&
                          memory->influence->size() == wish.cloud->size();
        if (same) shown.influence = memory->influence;
        if (memory->bound_cloud != wish.cloud) tell(false);
        shown.influence = influenceAt(wish, *memory);
      }
    } catch (const std::exception& e) {  // the border of this thread: said in the view
      shown.hint = QString("the joints cannot be read: ") + e.what();
    }
    tell(true);
  });
}

}  // namespace beam
