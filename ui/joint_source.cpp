// SPDX-License-Identifier: Apache-2.0
#include "ui/joint_source.h"

#include <algorithm>

#include "core/io/splat_ply.h"

namespace beam {
namespace {

constexpr const char* kTrackStage = "track";
constexpr const char* kJointsStep = "track.joints";
constexpr int kTrailFrames = 16;
// The binding of the skin (methods 3.5).
constexpr int kAnchors = 8;
constexpr float kReach_m = 0.02f;

const SurveyLane* trackLane(const TakeSurvey& survey) {
  const auto found = std::find_if(survey.lanes.begin(), survey.lanes.end(),
                                  [](const SurveyLane& lane) { return lane.stage == kTrackStage; });
  return found == survey.lanes.end() ? nullptr : &*found;
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

JointSource::JointSource(const ProjectModel& model, QObject* parent) : QObject(parent), model_(model) {}

JointsShown JointSource::answer(const Wish& wish, Memory& memory) {
  JointsShown shown;
  const SurveyLane* lane = trackLane(*wish.survey);
  if (!lane) return shown;  // this program tracks nothing
  const auto jointsOf = [&](int f) -> const JointPositions& {
    const Digest stamp = wish.survey->stamps[f];
    auto known = memory.joints.find(f);
    if (known == memory.joints.end() || known->second.first != stamp) {
      JointPositions positions;
      if (const auto folder = wish.project.result(kJointsStep, FrameIndex{f}))
        positions = readSplatPly(*folder / kJointsFile).cloud.position_m;
      known = memory.joints.insert_or_assign(f, std::pair(stamp, std::move(positions))).first;
    }
    return known->second.second;
  };
  const int last = wish.frame.value;
  const JointPositions& now = jointsOf(last);
  if (now.empty()) {
    shown.hint = "no joints of this frame yet: run until " + QString::fromStdString(lane->title);
    return shown;
  }
  int rest = last;
  while (rest > 0 && jointsOf(rest - 1).size() == now.size()) --rest;
  for (int f = std::max(rest, last - kTrailFrames + 1); f <= last; ++f) shown.trails.push_back(jointsOf(f));
  if (wish.picked < 0 || wish.picked >= static_cast<int>(now.size()) || !wish.cloud) return shown;
  if (!memory.bound || memory.bound_stamp != wish.survey->stamps[rest]) {
    const std::optional<FrameResult> skin = loadFrameResult(wish.project, FrameIndex{rest});
    memory.bound = nullptr;
    if (skin)
      memory.bound = std::make_shared<const Anchors>(
          anchorTo(skin->cloud.position_m, jointsOf(rest), kAnchors, kReach_m));
    memory.bound_stamp = wish.survey->stamps[rest];
  }
  // A frame that was fitted anew has other Gaussians than the rest frame: bound as they stand.
  const bool same = memory.bound && memory.bound->points() == wish.cloud->size();
  shown.influence = std::make_shared<const std::vector<float>>(influenceOf(
      same ? *memory.bound : anchorTo(wish.cloud->position_m, now, kAnchors, kReach_m), wish.picked));
  return shown;
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
    try {
      shown = answer(wish, *memory);
    } catch (const std::exception& e) {  // the border of this thread: said in the view
      shown.hint = QString("the joints cannot be read: ") + e.what();
    }
    QMetaObject::invokeMethod(
        this,
        [this, shown, ticket] {
          if (ticket != ticket_) return;
          seen_ = ticket;
          shown_ = shown;
          Q_EMIT changed();
        },
        Qt::QueuedConnection);
  });
}

}  // namespace beam
