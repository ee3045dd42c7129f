// SPDX-License-Identifier: Apache-2.0
// Photometric loss and Adam on the CPU, vectorised and threaded. Chosen through the device.
#pragma once

#include <memory>

#include "core/render/training_ops.h"

namespace beam {

std::unique_ptr<TrainingOps> makeCpuTrainingOps();

// SIMD steps on rows and ranges (one instruction set chosen at run time; all give the same bits).

// SSIM with its gradient and L1 on one channel (methods 1.10), rows [begin, end). The band rolls over the
// rows with what its 11-row windows need in `scratch`, which stays in the cache; rows at its borders are
// worked out by both neighbours.
struct SsimChannel {
  const float *image, *target;
  float* gradient;  // l1_scale sign(image - target) + ssim_scale d(sum of SSIM)/d(image)
  int width, height;
  float window[6];  // centre first: window[i] weighs pixels at distance i
  float l1_scale, ssim_scale;
  double *row_ssim, *row_l1;  // sums of every row
};
std::size_t ssimScratchFloats(int width);
// `scratch`: zero before the first call of a width, else as the last call left it.
void ssimBand(const SsimChannel& channel, int begin, int end, float* scratch);

struct AdamRange {
  float *parameter, *first, *second;
  const float* gradient;
  std::size_t count;  // multiple of 16
  float beta1, beta2, epsilon;
  float rate;          // learning rate / (1 - beta1^t)
  float inverse_root;  // 1 / sqrt(1 - beta2^t)
};
void adamStep(const AdamRange& range);

}  // namespace beam
