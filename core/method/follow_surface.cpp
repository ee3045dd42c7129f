// SPDX-License-Identifier: Apache-2.0
#include "core/method/follow_surface.h"

#include <cmath>

#include "core/math/quaternion.h"
#include "core/method/joint_warp.h"
#include "core/method/training_loop.h"
#include "core/optim/gaussian_model.h"
#include "core/optim/rigid_energy.h"

namespace beam {
namespace {

constexpr double kReach = 1.8;  // length of their weights in mean spacings: 0.02 m of methods 3.2

// The joints carry the Gaussians and learn under E_smooth, the residuals beside them where they are free.
class FollowRule final : public TrainingRule {
 public:
  FollowRule(const FollowInput& input, const CarriedSkin& start, const FollowSurfaceOptions& options,
             bool residual, float extent_m, double pixel_m)
      : options_(options),
        residual_(residual),
        before_(poseOf(input.previous.cloud)),
        reference_rest_(input.previous.rest_skin),
        graph_(surfaceGraph(reference_rest_.position_m, kReach)),
        lists_(listsOf(graph_, reference_rest_.size())),
        warp_(start.rest_skin, input.rest_joints, boundTo(reference_rest_, input.rest_joints)),
        joints_(start.joints),
        rest_(start.rest_skin),
        extent_m_(extent_m),
        pixel_m_(pixel_m) {}

  void place(GaussianModel& model) override {
    skin_ = warp_.skin(joints_.pose());
    model.place(skin_);
  }

  ModelStep learn(TrainingStep step, const GaussianBuffers& gradients, TrainingOps& ops) override {
    PoseGradient of_skin(skin_.size()), of_joints(joints_.pose().size());
    addPoseGradient(gradients, of_skin);
    rigidEnergy(graph_, lists_, before_, skin_, static_cast<float>(options_.smooth_weight), of_skin);
    if (options_.rest_weight > 0)
      rigidEnergy(graph_, lists_, reference_rest_, skin_, static_cast<float>(options_.rest_weight), of_skin);
    warp_.backward(joints_.pose(), of_skin, of_joints);
    if (residual_) moveRest(of_skin, step, ops);
    const PoseRates& r = options_.joint_rates;
    const float share = shareAt(r.last, step.index, options_.iterations);
    joints_.step(of_joints, static_cast<float>(r.position * pixel_m_) * share,
                 static_cast<float>(r.rotation) * share, step.adam, ops);
    return {ratesAt(options_.rates, step.index, options_.iterations, extent_m_),
            {.temporal = static_cast<float>(options_.temporal_weight)}};
  }

  // Of the pose that was placed last.
  double smoothEnergy() const {
    PoseGradient ignored(rest_.pose().size());
    return rigidEnergy(graph_, lists_, before_, skin_, 0, ignored);
  }
  const Pose& rest() const { return rest_.pose(); }
  const Pose& joints() const { return joints_.pose(); }

 private:
  void moveRest(const PoseGradient& of_skin, TrainingStep step, TrainingOps& ops) {
    const Pose& rest = rest_.pose();
    PoseGradient of_rest(rest.size());
    warp_.backwardToRest(joints_.pose(), of_skin, of_rest);
    const auto tie = static_cast<float>(2 * options_.residual_weight);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      of_rest.position[i] += tie * (rest.position_m[i] - reference_rest_.position_m[i]);
      of_rest.rotation[i] += tie * toVec4(rest.rotation[i] - reference_rest_.rotation[i]);
    }
    const PoseRates& r = options_.residual_rates;
    const float share = shareAt(r.last, step.index, options_.iterations);
    rest_.step(of_rest, static_cast<float>(r.position) * extent_m_ * share,
               static_cast<float>(r.rotation) * share, step.adam, ops);
    warp_.setRestSkin(rest_.pose());
  }

  const FollowSurfaceOptions& options_;
  bool residual_;
  Pose before_, reference_rest_;
  Anchors graph_;
  AnchorLists lists_;
  JointWarp warp_;
  PoseModel joints_, rest_;
  Pose skin_;  // as placed last
  float extent_m_;
  double pixel_m_;
};

struct Half {
  const CarriedSkin& start;
  const FitSurfaceOptions& fit;
  const FollowSurfaceOptions& options;
  bool geometry;
};

FollowedSkin followHalf(std::span<const FrameView> views, const FollowInput& input, const Half& half,
                        ComputeDevice& device, Progress& progress, const CloudPreview& preview) {
  const FollowSurfaceOptions& o = half.options;
  TrainingLoop loop(views, lossOptions(half.fit), half.geometry, input.previous.cloud, half.fit.filter,
                    device);
  GaussianModel& model = loop.model();
  loop.takeFilterOut(model);
  model.keepReference();  // of E_temp: that of the frame before, whatever the fit starts from
  if (half.geometry) {
    GaussianModel started(half.start.cloud);
    loop.takeFilterOut(started);
    model.takeAppearance(started);
  }
  FollowRule rule(input, half.start, o, half.geometry && o.residual, sceneExtent(views),
                  pixelAtSubject(loop.cameras(), half.start.joints.position_m));
  TrainingSpan span = halfOf(o.iterations, o.refine_fraction, half.geometry);
  span.filter_from = span.begin;
  progress.expect(span.end - span.begin, "iterations");
  loop.run(span, rule, progress, preview);
  loop.place(rule);
  return {{model.cloud(), rule.rest(), rule.joints()},
          rule.smoothEnergy(),
          model.temporalEnergy(Regularizers{}.temporal_shape)};
}

}  // namespace

Anchors boundTo(const Pose& skin, const Pose& joints) {
  const double spacing = spacingOf(joints.position_m);
  return anchorTo(skin.position_m, joints.position_m, kSurfaceNeighbors, static_cast<float>(kReach * spacing),
                  static_cast<float>(kNeighborsApart * spacing));
}

Pose carriedJoints(const Pose& tracked_before, const Pose& corrected_before, const Pose& tracked) {
  Pose out = tracked;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const quat back = glm::conjugate(glm::normalize(tracked_before.rotation[k]));
    const quat there = glm::normalize(tracked.rotation[k]);
    const vec3 shift = back * (corrected_before.position_m[k] - tracked_before.position_m[k]);
    out.position_m[k] += there * shift;
    out.rotation[k] = glm::normalize(there * (back * corrected_before.rotation[k]));
  }
  return out;
}

FollowedSkin followAppearance(std::span<const FrameView> views, const FollowInput& input,
                              const FitSurfaceOptions& fit, const FollowSurfaceOptions& options,
                              ComputeDevice& device, Progress& progress, const CloudPreview& preview) {
  const CarriedSkin start{input.previous.cloud, input.previous.rest_skin, input.joints};
  return followHalf(views, input, {start, fit, options, false}, device, progress, preview);
}

FollowedSkin followGeometry(std::span<const FrameView> views, const FollowInput& input,
                            const CarriedSkin& start, const FitSurfaceOptions& fit,
                            const FollowSurfaceOptions& options, ComputeDevice& device, Progress& progress,
                            const CloudPreview& preview) {
  return followHalf(views, input, {start, fit, options, true}, device, progress, preview);
}

namespace {

void describeAdvanced(Fields& f, FollowSurfaceOptions& o) {
  f.field(
      {.name = "residual_weight",
       .label = "Pull on own motion",
       .help = "How strongly the own motion of a Gaussian beside its joints stays that of the frame before.",
       .min = 0,
       .max = 1e6,
       .advanced = true},
      o.residual_weight);
  f.field(
      {.name = "residual_rate",
       .label = "Learning rate, own position",
       .help = "Learning rate of the own positions beside the joints, as a share of the extent of the scene.",
       .min = 0,
       .max = 1,
       .advanced = true},
      o.residual_rates.position);
  f.field({.name = "residual_rotation_rate",
           .label = "Learning rate, own rotation",
           .help = "Learning rate of the own rotations beside the joints.",
           .min = 0,
           .max = 1,
           .unit = "rad",
           .advanced = true},
          o.residual_rates.rotation);
  f.field({.name = "joint_rate",
           .label = "Learning rate, joint position",
           .help = "Learning rate of the correction of the joints' positions at the first step, in pixels; "
                   "falls to a tenth.",
           .min = 0,
           .max = 10,
           .unit = "px",
           .advanced = true},
          o.joint_rates.position);
  f.field(
      {.name = "joint_rotation_rate",
       .label = "Learning rate, joint rotation",
       .help =
           "Learning rate of the correction of the joints' rotations at the first step; falls to a tenth.",
       .min = 0,
       .max = 1,
       .unit = "rad",
       .advanced = true},
      o.joint_rates.rotation);
  f.field({.name = "scale_rate",
           .label = "Learning rate, size, later frames",
           .help = "Learning rate of the logarithms of the sizes in later frames.",
           .min = 0,
           .max = 1,
           .advanced = true},
          o.rates.log_scale);
  f.field({.name = "opacity_rate",
           .label = "Learning rate, opacity, later frames",
           .help = "Learning rate of the opacities before their sigmoid (logits) in later frames.",
           .min = 0,
           .max = 1,
           .advanced = true},
          o.rates.opacity_logit);
  f.field({.name = "color_rate",
           .label = "Learning rate, colour, later frames",
           .help = "Learning rate, in later frames, of the colour that is the same from every side; what "
                   "depends on the view learns half as fast.",
           .min = 0,
           .max = 1,
           .advanced = true},
          o.rates.color);
}

}  // namespace

void describe(Fields& f, FollowSurfaceOptions& o) {
  f.field({.name = "iterations",
           .label = "Iterations, later frames",
           .help = "Optimiser steps of a frame that follows another; the paper takes 7,000 + 5,000.",
           .min = 2,
           .max = 1e6},
          o.iterations);
  f.field({.name = "refine_fraction",
           .label = "Share of steps with normals, later frames",
           .help = "The last part of the steps of a later frame, as a share of all, also makes the normals "
                   "of the Gaussians agree with those of the rendered depth.",
           .min = 0,
           .max = 1},
          o.refine_fraction);
  f.field({.name = "smooth_weight",
           .label = "Smoothness of motion",
           .help = "How strongly neighbouring Gaussians are made to move alike from frame to frame; the "
                   "paper takes 0.001.",
           .min = 0,
           .max = 100},
          o.smooth_weight);
  f.field({.name = "rest_weight",
           .label = "Hold to the first shape",
           .help = "How strongly neighbouring Gaussians keep the places to each other that they had in the "
                   "first frame of the take; 0 is the way of the paper.",
           .min = 0,
           .max = 100},
          o.rest_weight);
  f.field({.name = "temporal_weight",
           .label = "Hold to the frame before",
           .help = "How strongly the appearance of a Gaussian stays that of the frame before, against "
                   "flicker; the paper takes 0.00005.",
           .min = 0,
           .max = 100},
          o.temporal_weight);
  f.field(
      {
          .name = "residual",
          .label = "Own motion beside the joints",
          .help = "Lets each Gaussian move a little away from the joints that carry it, in the steps with "
                  "normals; off is the way of the paper.",
      },
      o.residual);
  describeAdvanced(f, o);
}

}  // namespace beam
