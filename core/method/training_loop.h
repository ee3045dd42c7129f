// SPDX-License-Identifier: Apache-2.0
// The loop of every fit of Gaussians to photographs, one view a step: place, filter, draw, compare, learn.
// What one fit does its own way (where the Gaussians stand, what else learns, how fast, whether the count
// changes) is its TrainingRule.
#pragma once

#include "core/base/progress.h"
#include "core/method/preview.h"
#include "core/method/view_loss.h"
#include "core/optim/gaussian_model.h"

namespace beam {

struct TrainingStep {
  int index = 0;  // of the whole fit: it draws the view and is what schedules go by
  int adam = 1;   // since the moments are zero, from 1
};

// How Adam moves the Gaussians' own values in a step.
struct ModelStep {
  LearningRates rates;
  Regularizers regularizers;
};

class TrainingRule {
 public:
  virtual ~TrainingRule() = default;

  virtual int shDegree(int /*step*/) const { return 3; }  // bands of SH that are drawn and learn, 0 to 3
  // Moves the Gaussians to where the step finds them.
  virtual void place(GaussianModel& /*model*/) {}
  // `gradients` holds dL/d(physical) of the step's view. Whatever stands behind the Gaussians learns here.
  virtual ModelStep learn(TrainingStep step, const GaussianBuffers& gradients, TrainingOps& ops) = 0;
  // After Adam: noise, growth.
  virtual void finish(GaussianModel& /*model*/, TrainingStep /*step*/) {}
};

// Steps [begin, end) of a fit. The 3D filter is renewed at the first of them and at every hundredth, counted
// from `filter_from`.
struct TrainingSpan {
  int begin = 0, end = 0;
  int filter_from = 0;
};
// The halves of a fit: the first without E_normal, the last share of the steps with it.
TrainingSpan halfOf(int iterations, double refine_fraction, bool geometry);

class TrainingLoop {
 public:
  // `filter`: strength of the 3D filter (methods 1.3). `geometry`: with E_normal.
  TrainingLoop(std::span<const FrameView> views, const ViewLossOptions& loss, bool geometry,
               const GaussianCloud& start, double filter, ComputeDevice& device);

  GaussianModel& model() { return model_; }
  const GaussianModel& model() const { return model_; }
  std::span<const Camera> cameras() const { return loss_.cameras(); }
  void takeFilterOut(GaussianModel& model) const { model.takeFilterOut(cameras(), filter_); }

  // One Progress::step a step; how many are to be expected is said by the caller, who may have others.
  void run(const TrainingSpan& span, TrainingRule& rule, Progress& progress,
           const CloudPreview& preview = {});
  // The Gaussians where the rule has them, with the filter of that place.
  void place(TrainingRule& rule);

 private:
  void renewFilter() { model_.updateFilter(cameras(), filter_); }

  ViewLoss loss_;
  GaussianModel model_;
  float filter_;
  GaussianBuffers gradients_;
};

}  // namespace beam
