// SPDX-License-Identifier: Apache-2.0
// Gaussians under optimisation: raw parameters (log scale, logit opacity), the 3D filter, and Adam's moments.
// The only place that knows the raw form besides the splat PLY dialect.
#pragma once

#include <span>
#include <vector>

#include "core/optim/learning_rates.h"
#include "core/optim/pose_model.h"
#include "core/render/training_ops.h"
#include "core/scene/camera.h"
#include "core/scene/gaussian_cloud.h"

namespace beam {

// Weights of MCMC's regularisers, means over Gaussians (methods 1.12), and of the shape of joints (methods
// 3.2): isotropy mean_i max(s_max / s_min, 4), size sum_i relu(s_max - 5 m) + relu(m / 5 - s_max) in metres,
// m the mean of all scales.
struct Regularizers {
  float opacity = 0;
  float scale = 0;
  float isotropy = 0;
  float size = 0;
  // E_temp of BEAM eq. 10 against keepReference(): a plain sum over Gaussians of squared changes of raw
  // values, SH times 1, log scale and logit opacity times `temporal_shape` (methods 3.7).
  float temporal = 0;
  float temporal_shape = 0.003f;
};

class GaussianModel {
 public:
  explicit GaussianModel(const GaussianCloud& cloud);

  std::size_t size() const { return values_.count; }
  // Physical values with the 3D filter in them, as the rasteriser draws them; call after activate().
  const GaussianBuffers& physical() const { return values_; }
  // Raw planes to physical ones: scale sqrt(s^2 + f^2), opacity o sqrt(prod s^2 / (s^2 + f^2)) (methods 1.3).
  void activate();

  // Sizes of the 3D filter: f = strength * sqrt(0.2) * min over cameras of depth / focal, over cameras that
  // see the Gaussian within 15 % of their borders; unseen Gaussians take the largest (methods 1.3). 0: no
  // filter.
  void updateFilter(std::span<const Camera> cameras, float strength);
  // Takes that filter out of the raw values: for a cloud that was made with the filter baked in.
  void takeFilterOut(std::span<const Camera> cameras, float strength);

  // The present raw appearance is what E_temp holds on to.
  void keepReference();
  // E_temp without its weight.
  double temporalEnergy(float shape_share) const;
  // Raw appearance of as many others; poses, moments and the reference stay.
  void takeAppearance(const GaussianModel& other);
  // Moves the Gaussians; appearance and moments stay.
  void place(const Pose& pose);

  // Chains dL/d(physical) to the raw parameters (in place) and takes Adam's step `step` (from 1).
  void step(GaussianBuffers& gradients, const LearningRates& rates, int sh_degree,
            const Regularizers& regularizers, int step, TrainingOps& ops);

  // Opacity without the filter, in (0, 1).
  float opacity(std::size_t i) const;
  // Copies of Gaussians: target[i] becomes a copy of source[i]; targets may lie at or behind size(), up to
  // `new_size`. Sources and targets then take the opacity and scales of `relocate` (methods 1.12) and lose
  // their moments.
  void relocate(std::span<const std::uint32_t> source, std::span<const std::uint32_t> target,
                std::size_t new_size);
  // position += covariance * eta * sigmoid(-100 (o - 0.005)) * amount, eta standard normal (MCMC).
  void addNoise(float amount, std::uint64_t seed, int step);
  // Keeps the Gaussians whose flag is set.
  void keep(std::span<const std::uint8_t> flags);

  // Physical values, filter baked in.
  GaussianCloud cloud() const;

 private:
  void resize(std::size_t count);
  // dE/d(log scale) of the shape terms, into chained gradients.
  void addShapeGradient(GaussianBuffers& gradients, const Regularizers& regularizers) const;
  void addTemporalGradient(GaussianBuffers& gradients, const Regularizers& regularizers) const;
  float* raw(int k) { return raw_.data() + values_.stride * k; }  // log scale 0-2, logit opacity 3
  const float* raw(int k) const { return raw_.data() + values_.stride * k; }

  GaussianBuffers values_;    // scale and opacity planes physical, all others are the parameters themselves
  AlignedVector<float> raw_;  // 4 planes
  AlignedVector<float> filter_;  // metres
  GaussianBuffers first_moment_, second_moment_;
  AlignedVector<float> reference_;  // planes from kScale on, as Adam sees them
};

// Opacity and scale factor of n composited copies that look like one Gaussian of opacity o (methods 1.12).
struct Relocation {
  float opacity = 0;
  float scale = 1;
};
Relocation relocation(float opacity, int copies);

}  // namespace beam
