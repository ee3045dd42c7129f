// SPDX-License-Identifier: Apache-2.0
#include "ui/joint_source.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace beam {
namespace {

constexpr const char* kTrackStage = "track";
constexpr int kTrailFrames = 16;

// What a run must reach for a frame to have joints; empty: this program tracks nothing, or nothing is run
// here.
QString trackTitle(const ProjectModel& model) {
  const auto survey = model.survey();
  if (!survey) return {};
  const auto found = std::find_if(survey->lanes.begin(), survey->lanes.end(),
                                  [](const SurveyLane& lane) { return lane.stage == kTrackStage; });
  return found == survey->lanes.end() ? QString() : QString::fromStdString(found->title);
}

}  // namespace

std::vector<float> influenceOf(const SkinBinding& binding, std::uint32_t joint) {
  std::vector<float> shares(binding.points(), 0.0f);
  for (std::size_t i = 0; i < binding.target.size(); ++i) {
    if (binding.target[i] == joint) shares[i / binding.per_point] = binding.weight[i];
  }
  return shares;
}

struct JointSource::Wish {
  std::shared_ptr<const GaussianSequence> sequence;
  QString track_title;
  FrameIndex frame;
  int picked = -1;
  std::shared_ptr<const GaussianCloud> cloud;  // of the frame
};

struct JointSource::Memory {
  std::string of;                                                                // the sequence's id
  std::map<std::int32_t, std::pair<std::optional<Digest>, FrameJoints>> joints;  // by frame, with its stamp
  std::shared_ptr<const GaussianCloud> bound_cloud;
  std::shared_ptr<const SkinBinding> bound;             // null: the skin is not that of `bound_cloud`
  std::shared_ptr<const std::vector<float>> influence;  // told last, of `picked`
  int picked = -1;
};

JointSource::JointSource(const ProjectModel& model, QObject* parent)
    : QObject(parent), model_(model), memory_(std::make_shared<Memory>()) {}

JointsShown JointSource::trailsAt(const Wish& wish, Memory& memory) {
  JointsShown shown;
  const GaussianSequence& sequence = *wish.sequence;
  if (memory.of != sequence.id()) {
    memory = {};
    memory.of = sequence.id();
  }
  const auto jointsOf = [&](FrameIndex f) -> const FrameJoints& {
    const std::optional<Digest> stamp = sequence.stamp(f);
    auto known = memory.joints.find(f.value);
    if (known == memory.joints.end() || known->second.first != stamp)
      known = memory.joints.insert_or_assign(f.value, std::pair(stamp, sequence.joints(f))).first;
    return known->second.second;
  };
  const std::size_t count = jointsOf(wish.frame).pose.size();
  if (count == 0) {
    if (!wish.track_title.isEmpty())
      shown.hint = "no joints of this frame yet: run until " + wish.track_title;
    return shown;
  }
  for (std::optional<FrameIndex> at = wish.frame; at && shown.trails.size() < kTrailFrames;) {
    const FrameJoints& joints = jointsOf(*at);
    if (joints.pose.size() != count) break;
    shown.trails.push_back(joints.pose.position_m);
    at = joints.restarted ? std::nullopt : sequence.before(*at);
  }
  std::reverse(shown.trails.begin(), shown.trails.end());
  const int stride =
      wish.frame.value - sequence.before(wish.frame).value_or(FrameIndex{wish.frame.value - 1}).value;
  std::erase_if(memory.joints, [&](const auto& known) {
    return std::abs(known.first - wish.frame.value) > kTrailFrames * stride;
  });
  return shown;
}

std::shared_ptr<const std::vector<float>> JointSource::influenceAt(const Wish& wish, Memory& memory) {
  if (memory.bound_cloud != wish.cloud) {
    const std::optional<SequenceTake> take = wish.sequence->take(wish.frame);
    const bool fits = take && take->binding.points() == wish.cloud->size();
    memory.bound = fits ? std::make_shared<const SkinBinding>(take->binding) : nullptr;
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
  const std::shared_ptr<const GaussianSequence> sequence = model_.sequence();
  if (!sequence || (model_.isOpen() && !model_.survey())) {
    seen_ = ++ticket_;
    shown_ = {};
    Q_EMIT changed();
    return;
  }
  const std::uint64_t ticket = ++ticket_;
  const Wish wish{sequence, trackTitle(model_), model_.frame(), picked_, model_.values().cloud};
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
