// SPDX-License-Identifier: Apache-2.0
// All that a training step needs besides the rasteriser: the photometric loss with its gradient, and Adam,
// both over planes. No allocation after the first call of a size; the same bits for any thread count and
// instruction set.
#pragma once

#include <span>

#include "core/image/image.h"
#include "core/render/gaussian_buffers.h"

namespace beam {

struct PhotometricLoss {
  double l1 = 0;     // mean |I - I*| over pixels and channels
  double ssim = 0;   // mean SSIM, 11x11 window, zero padding (methods 1.10)
  double total = 0;  // (1 - lambda) l1 + lambda (1 - ssim)
};

// One rule of a parameter plane's Adam step.
struct AdamPlane {
  float learning_rate = 0;  // 0: the plane stays as it is and its moments are not touched
};

struct AdamSettings {
  float beta1 = 0.9f, beta2 = 0.999f, epsilon = 1e-15f;
};

class TrainingOps {
 public:
  virtual ~TrainingOps() = default;

  // L = (1 - lambda) L1 + lambda (1 - SSIM). `gradient` (3 planes, resized) receives dL/d(image).
  virtual PhotometricLoss photometric(const Planes& image, const Planes& target, float lambda,
                                      Planes& gradient) = 0;

  // One Adam step over all planes (methods 1.11): m, v and parameters in place. `step` counts from 1.
  // `planes` has one entry a plane of the buffers. A zero gradient with zero moments moves nothing.
  virtual void adam(GaussianBuffers& parameters, const GaussianBuffers& gradients,
                    GaussianBuffers& first_moment, GaussianBuffers& second_moment,
                    std::span<const AdamPlane> planes, const AdamSettings& settings, int step) = 0;
};

}  // namespace beam
