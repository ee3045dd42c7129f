// SPDX-License-Identifier: Apache-2.0
#include "core/method/training_loop.h"

#include <cmath>

namespace beam {

constexpr int kFilterEvery = 100;  // steps

TrainingSpan halfOf(int iterations, double refine_fraction, bool geometry) {
  const int between = static_cast<int>(std::lround(iterations * (1 - refine_fraction)));
  return geometry ? TrainingSpan{between, iterations} : TrainingSpan{0, between};
}

TrainingLoop::TrainingLoop(std::span<const FrameView> views, const ViewLossOptions& loss, bool geometry,
                           const GaussianCloud& start, double filter, ComputeDevice& device)
    : loss_(views, loss, geometry, device), model_(start), filter_(static_cast<float>(filter)) {}

void TrainingLoop::run(const TrainingSpan& span, TrainingRule& rule, Progress& progress,
                       const CloudPreview& preview) {
  TimedPreview shown(preview);
  for (int step = span.begin; step < span.end; ++step) {
    progress.step();
    const TrainingStep at{.index = step, .adam = step - span.begin + 1};
    const int sh_degree = rule.shDegree(step);
    rule.place(model_);
    if (step == span.begin || (step - span.filter_from) % kFilterEvery == 0) renewFilter();
    model_.activate();
    loss_.gradient(model_.physical(), loss_.drawOf(step), sh_degree, gradients_);
    const ModelStep own = rule.learn(at, gradients_, loss_.ops());
    model_.step(gradients_, own.rates, sh_degree, own.regularizers, at.adam, loss_.ops());
    rule.finish(model_, at);
    shown.offer(model_);
  }
}

void TrainingLoop::place(TrainingRule& rule) {
  rule.place(model_);
  renewFilter();
}

}  // namespace beam
