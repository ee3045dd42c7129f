// SPDX-License-Identifier: Apache-2.0
#include "core/method/track_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/method/fit_surface.h"
#include "core/method/joint_warp.h"
#include "core/method/training_loop.h"
#include "core/method/training_views.h"
#include "core/method/view_loss.h"
#include "core/optim/gaussian_model.h"
#include "core/optim/pose_model.h"
#include "core/optim/rigid_energy.h"

namespace beam {
namespace {

constexpr int kFewestNodes = 64;  // of a coarse level
constexpr int kSmallestSide = 4;  // of its pictures, pixels
constexpr int kVelocityRounds = 8;
constexpr std::uint32_t kLevelBackgrounds = 0x7acc0u;  // plus the level: stream of the random backgrounds
constexpr int kSmoothRounds = 30;                      // a standard deviation of about four spacings

// Indices in the order of farthest-point sampling from the first: every beginning of it covers the points
// evenly.
std::vector<std::uint32_t> spreadOrder(std::span<const vec3> points, std::size_t count) {
  std::vector<float> distance(points.size(), std::numeric_limits<float>::max());
  std::vector<std::uint32_t> order;
  std::uint32_t next = 0;
  while (order.size() < std::min(count, points.size())) {
    order.push_back(next);
    float farthest = -1;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const vec3 d = points[i] - points[order.back()];
      distance[i] = std::min(distance[i], glm::dot(d, d));
      if (distance[i] > farthest) farthest = distance[i], next = i;
    }
  }
  return order;
}

Pose chosen(const Pose& pose, std::span<const std::uint32_t> indices) {
  Pose out;
  for (const std::uint32_t i : indices) {
    out.position_m.push_back(pose.position_m[i]);
    out.rotation.push_back(pose.rotation[i]);
  }
  return out;
}

std::vector<FrameView> shrunkAll(std::span<const FrameView> views, int factor) {
  std::vector<FrameView> small(views.size());
  parallelFor(views.size(), 1, [&](std::size_t v, std::size_t) { small[v] = shrunk(views[v], factor); });
  return small;
}

// Levels whose pictures are large enough to tell anything.
int levelsOf(std::span<const FrameView> views, int wanted) {
  int side = std::numeric_limits<int>::max();
  for (const FrameView& v : views) side = std::min({side, v.camera.width, v.camera.height});
  while (wanted > 0 && (side >> wanted) < kSmallestSide) --wanted;
  return wanted;
}

// The joints drawn at one level, on its pictures.
class LevelView {
 public:
  LevelView(std::span<const FrameView> views, int level, const GaussianCloud& joints,
            const ViewLossOptions& options, ComputeDevice& device)
      : loss_(level > 0 ? ViewLoss(shrunkAll(views, 1 << level), options, false, device)
                        : ViewLoss(views, options, false, device)),
        pixel_m_(pixelAtSubject(loss_.cameras(), joints.position_m)) {
    GaussianModel model(joints);
    // That of full pictures is in the joints already (fitFirstJoints).
    if (level > 0) model.updateFilter(loss_.cameras(), 1);
    model.activate();
    drawn_ = model.physical();
  }

  std::size_t size() const { return loss_.size(); }
  double pixelSize() const { return pixel_m_; }  // metres at the subject
  TrainingOps& ops() { return loss_.ops(); }
  ViewDraw drawOf(int step, std::uint32_t stream) const { return loss_.drawOf(step, stream); }

  double loss(const Pose& pose, ViewDraw what) {
    setPose(drawn_, pose);
    loss_.draw(drawn_, what, 3);
    return loss_.compare().total();
  }
  // Adds the gradient of one view's loss.
  void addGradient(const Pose& pose, ViewDraw what, PoseGradient& gradient) {
    loss(pose, what);
    loss_.backward(gradients_);
    addPoseGradient(gradients_, gradient);
  }

  // Mean over all views on black.
  double lossOfAll(const Pose& pose, const Progress& progress) {
    double sum = 0;
    for (std::size_t v = 0; v < size(); ++v) {
      progress.check();
      sum += loss(pose, {.view = v});
    }
    return sum / static_cast<double>(size());
  }

 private:
  ViewLoss loss_;
  GaussianBuffers drawn_, gradients_;
  double pixel_m_;
};

// Of the joints: L1 and the mask (BEAM 3.1).
ViewLossOptions jointLoss(double mask_weight, int seed) {
  return {.ssim_weight = 0, .mask_weight = mask_weight, .seed = seed};
}

// Band 0 of the colours alone.
class ShadingRule final : public TrainingRule {
 public:
  explicit ShadingRule(int steps) : steps_(steps) {}
  ModelStep learn(TrainingStep step, const GaussianBuffers& /*gradients*/, TrainingOps& /*ops*/) override {
    return {{.color_dc = ratesAt(kShadingRates, step.index, steps_, 0).color_dc}, {}};
  }

 private:
  int steps_;
};

class JointTracker {
 public:
  JointTracker(std::span<const FrameView> views, const JointHistory& history,
               const TrackJointsOptions& options, ComputeDevice& device)
      : views_(views),
        history_(history),
        options_(options),
        device_(device),
        graph_(surfaceGraph(history.rest.position_m, options.rigid_spacings)),
        previous_(poseOf(history.previous)),
        pose_(previous_),
        levels_(levelsOf(views, options.levels)) {
    const std::size_t count = history.previous.size();
    if (history.rest.size() != count || (!history.before_m.empty() && history.before_m.size() != count)) {
      throw Error(Error::Kind::Bug,
                  fmt::format("expected {} joints at rest and in the frames before, found {} and {}", count,
                              history.rest.size(), history.before_m.size()));
    }
    if (levels_ > 0) order_ = spreadOrder(history.rest.position_m, nodesOf(1));
  }

  TrackedJoints run(Progress& progress, const CloudPreview& preview) {
    progress.expect(options_.iterations + options_.recolor_iterations, "iterations");
    TrackedJoints result;
    for (int level = levels_; level >= 0; --level) {
      progress.check();
      LevelView view(views_, level, history_.previous, jointLoss(options_.mask_weight, options_.seed),
                     device_);
      if (level == levels_) predict(view, progress);
      const double rigid = level > 0 ? moveNodes(level, view, progress) : moveJoints(view, progress);
      if (preview) preview(std::make_shared<GaussianCloud>(posed()));
      if (level > 0) continue;
      result.residual = view.lossOfAll(pose_, progress);
      result.rigid = rigid;
    }
    result.joints = posed();
    if (options_.recolor_iterations > 0) recolor(result.joints, progress);
    return result;
  }

 private:
  std::size_t nodesOf(int level) const {
    const std::size_t all = history_.rest.size();
    return std::min(all, std::max<std::size_t>(kFewestNodes, all >> (2 * level)));
  }

  int stepsOf(int level) const {
    const int coarse = options_.iterations / (2 * (levels_ + 1));
    return level > 0 ? coarse : options_.iterations - coarse * levels_;
  }

  GaussianCloud posed() const {
    GaussianCloud cloud = history_.previous;
    setPose(cloud, pose_);
    return cloud;
  }

  void predict(LevelView& view, const Progress& progress) {
    if (history_.before_m.empty()) return;
    std::vector<vec3> velocity(previous_.size());
    for (std::size_t i = 0; i < velocity.size(); ++i)
      velocity[i] = previous_.position_m[i] - history_.before_m[i];
    // A hidden joint's velocity is noise that would grow from frame to frame.
    for (int round = 0; round < kVelocityRounds; ++round) velocity = averaged(graph_, velocity);
    Pose predicted = previous_;
    for (std::size_t i = 0; i < predicted.size(); ++i) predicted.position_m[i] += velocity[i];
    if (view.lossOfAll(predicted, progress) < view.lossOfAll(pose_, progress)) pose_ = std::move(predicted);
  }

  double moveNodes(int level, LevelView& view, Progress& progress) {
    const std::span<const std::uint32_t> nodes(order_.data(), nodesOf(level));
    const Pose rest = chosen(history_.rest, nodes), start = chosen(pose_, nodes);
    const float reach = static_cast<float>(options_.rigid_spacings * spacingOf(rest.position_m));
    const JointWarp warp(pose_, start,
                         anchorTo(history_.rest.position_m, rest.position_m, kSurfaceNeighbors, reach));
    PoseModel model(start);
    const Pose before = chosen(previous_, nodes);
    const double rigid = descend(level, surfaceGraph(rest.position_m, options_.rigid_spacings), rest, before,
                                 model, view, progress, &warp);
    pose_ = warp.skin(model.pose());
    return rigid;
  }

  double moveJoints(LevelView& view, Progress& progress) {
    PoseModel model(pose_);
    const double rigid = descend(0, graph_, history_.rest, previous_, model, view, progress, nullptr);
    pose_ = model.pose();
    return rigid;
  }

  // Returns E_rigid at the end. Without `warp` the model's pose is that of the joints.
  double descend(int level, const Anchors& graph, const Pose& rest, const Pose& before, PoseModel& model,
                 LevelView& view, Progress& progress, const JointWarp* warp) {
    const AnchorLists lists = listsOf(graph, before.size());
    const int steps = stepsOf(level);
    const std::size_t batch = std::min<std::size_t>(view.size(), std::size_t{1} << (2 * std::min(level, 4)));
    for (int step = 0; step < steps; ++step) {
      progress.step();
      const Pose& pose = model.pose();
      const Pose joints = warp ? warp->skin(pose) : pose;
      PoseGradient of_joints(joints.size()), of_model(pose.size());
      for (std::size_t b = 0; b < batch; ++b) {
        const int at = step * static_cast<int>(batch) + static_cast<int>(b);
        view.addGradient(joints, view.drawOf(at, kLevelBackgrounds + level), of_joints);
      }
      if (warp) {
        warp->backward(pose, of_joints, of_model);
      } else {
        of_model = std::move(of_joints);
      }
      const auto n = static_cast<float>(batch);  // the photometric gradient is a sum over the batch
      rigidEnergy(graph, lists, before, pose, static_cast<float>(options_.rigid_weight) * n, of_model);
      if (options_.rest_weight > 0)
        rigidEnergy(graph, lists, rest, pose, static_cast<float>(options_.rest_weight) * n, of_model);
      const PoseRates& r = options_.rates;
      const float share = shareAt(r.last, step, steps);
      model.step(of_model, static_cast<float>(r.position * view.pixelSize()) * share,
                 static_cast<float>(r.rotation) * static_cast<float>(1 << level) * share, step + 1,
                 view.ops());
    }
    PoseGradient ignored(before.size());
    return rigidEnergy(graph, lists, before, model.pose(), 0, ignored);
  }

  // A body that turns is shaded anew, and colours of another shading pull the joints off the skin. Only what
  // changes alike over neighbours is taken on: shading is smooth, and the texture is what holds the joints.
  void recolor(GaussianCloud& joints, Progress& progress) {
    ShadingRule rule(options_.recolor_iterations);
    TrainingLoop loop(views_, jointLoss(0, options_.seed), false, joints, 0, device_);
    loop.run({.end = options_.recolor_iterations}, rule, progress);
    const GaussianCloud changed = loop.model().cloud();
    std::vector<vec3> shading(joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i) {
      for (int c = 0; c < 3; ++c) shading[i][c] = changed.color.of(i)[c] - joints.color.of(i)[c];
    }
    for (int round = 0; round < kSmoothRounds; ++round) shading = averaged(graph_, shading);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      for (int c = 0; c < 3; ++c) joints.color.of(i)[c] += shading[i][c];
    }
  }

  // Half of one's own, half of the neighbours'.
  static std::vector<vec3> averaged(const Anchors& graph, const std::vector<vec3>& values) {
    std::vector<vec3> out(values.size());
    const auto n = static_cast<std::size_t>(graph.per_point);
    for (std::size_t i = 0; i < values.size(); ++i) {
      out[i] = 0.5f * values[i];
      for (std::size_t s = i * n; s < (i + 1) * n; ++s)
        out[i] += 0.5f * graph.weight[s] * values[graph.target[s]];
    }
    return out;
  }

  std::span<const FrameView> views_;
  const JointHistory& history_;
  const TrackJointsOptions& options_;
  ComputeDevice& device_;
  Anchors graph_;                     // of the joints
  std::vector<std::uint32_t> order_;  // nodes of the coarse levels
  Pose previous_, pose_;
  int levels_;
};

}  // namespace

GaussianCloud fitFirstJoints(std::span<const FrameView> views, const PointCloud& seeds,
                             const TrackJointsOptions& options, ComputeDevice& device, Progress& progress,
                             const CloudPreview& preview) {
  FitSurfaceOptions fit;
  fit.iterations = options.first_iterations;
  fit.refine_fraction = 0;
  fit.cap = options.joints;
  fit.seed = options.seed;
  fit.mask_weight = options.mask_weight;
  fit.isotropy_weight = options.isotropy_weight;
  fit.size_weight = options.size_weight;
  return fitAppearance(views, seeds, fit, device, progress, preview);
}

TrackedJoints trackJoints(std::span<const FrameView> views, const JointHistory& history,
                          const TrackJointsOptions& options, ComputeDevice& device, Progress& progress,
                          const CloudPreview& preview) {
  return JointTracker(views, history, options, device).run(progress, preview);
}

double jointResidual(std::span<const FrameView> views, const GaussianCloud& joints, double mask_weight,
                     ComputeDevice& device, const Progress& progress) {
  return LevelView(views, 0, joints, jointLoss(mask_weight, 0), device).lossOfAll(poseOf(joints), progress);
}

static void describeAdvanced(Fields& f, TrackJointsOptions& o);

void describe(Fields& f, TrackJointsOptions& o) {
  f.field({.name = "joints",
           .label = "Joints",
           .help = "Coarse Gaussians that carry the motion of the surface; they are no joints of a skeleton. "
                   "The paper takes about 15,000.",
           .min = 100,
           .max = 200000},
          o.joints);
  f.field({.name = "first_iterations",
           .label = "Iterations, first frame",
           .help = "Optimiser steps that fit the joints to the first frame of a take.",
           .min = 10,
           .max = 1e6},
          o.first_iterations);
  f.field({.name = "iterations",
           .label = "Iterations, later frames",
           .help = "Optimiser steps that move the joints into the next frame, over all levels; a run "
                   "counts the shading iterations, too.",
           .min = 2,
           .max = 1e6},
          o.iterations);
  f.field({.name = "levels",
           .label = "Coarse levels",
           .help = "Passes over smaller pictures, each half the size, before the full ones: more of them "
                   "catch faster limbs.",
           .min = 0,
           .max = 6},
          o.levels);
  f.field(
      {.name = "rigid_weight",
       .label = "Rigidity",
       .help = "How strongly neighbouring joints are made to move as one rigid piece; the paper takes 0.05.",
       .min = 0,
       .max = 100},
      o.rigid_weight);
  f.field(
      {.name = "rest_weight",
       .label = "Hold to the first shape",
       .help =
           "How strongly neighbouring joints keep the places to each other that they had in the first frame, "
           "so that joints that were hidden come back to their neighbours; 0 is the way of the paper.",
       .min = 0,
       .max = 100},
      o.rest_weight);
  describeAdvanced(f, o);
}

static void describeAdvanced(Fields& f, TrackJointsOptions& o) {
  f.field({.name = "rigid_spacings",
           .label = "Reach of rigidity",
           .help = "How far a joint acts on its neighbours, in mean distances between joints (with the "
                   "paper's 15,000 joints on a person: 0.02 m).",
           .min = 0.1,
           .max = 100,
           .advanced = true},
          o.rigid_spacings);
  f.field({.name = "mask_weight",
           .label = "Mask weight",
           .help = "How strongly the covered area is pulled towards the mask; 0 switches it off.",
           .min = 0,
           .max = 10,
           .advanced = true},
          o.mask_weight);
  f.field({.name = "position_rate",
           .label = "Learning rate, position",
           .help = "Learning rate of the joints' positions at the first step, in pixels of the level.",
           .min = 0,
           .max = 10,
           .unit = "px",
           .advanced = true},
          o.rates.position);
  f.field(
      {.name = "rotation_rate",
       .label = "Learning rate, rotation",
       .help = "Learning rate of the joints' rotations at the first step; doubles with every coarser level.",
       .min = 0,
       .max = 1,
       .unit = "rad",
       .advanced = true},
      o.rates.rotation);
  f.field({.name = "isotropy_weight",
           .label = "Roundness",
           .help = "How strongly joints over four times longer than thick are made rounder.",
           .min = 0,
           .max = 10,
           .advanced = true},
          o.isotropy_weight);
  f.field(
      {.name = "size_weight",
       .label = "Equal sizes",
       .help =
           "How strongly joints over five times or under a fifth of the mean size are brought towards it.",
       .min = 0,
       .max = 100,
       .advanced = true},
      o.size_weight);
  f.field({.name = "recolor_iterations",
           .label = "Shading iterations",
           .help = "Steps that bring the colours of the joints to the shading of each frame, smoothly over "
                   "the body; 0 keeps those of the first frame, the way of the paper.",
           .min = 0,
           .max = 1e5,
           .advanced = true},
          o.recolor_iterations);
  f.field({.name = "seed",
           .label = "Random seed",
           .help = "Start of the random numbers: the same number gives the same result again, another one a "
                   "slightly different result.",
           .min = 0,
           .max = 1e9,
           .advanced = true},
          o.seed);
}

}  // namespace beam
