// SPDX-License-Identifier: Apache-2.0
// Photometric loss and Adam on the CPU, vectorised and threaded. Chosen through the device.
#pragma once

#include <memory>

#include "core/render/training_ops.h"

namespace beam {

std::unique_ptr<TrainingOps> makeCpuTrainingOps();

// SIMD steps on rows and ranges (one instruction set chosen at run time; all give the same bits).

// Separable 11-tap Gaussian of standard deviation 1.5 over planes with kSsimPad zeros around the rows.
inline constexpr int kSsimPad = 16, kSsimReach = 5;

// Five (or three) padded rows to their horizontally blurred rows.
struct SsimRows {
  int width;        // of the picture
  int stride;       // floats a padded row
  float window[6];  // centre first: window[i] weighs pixels at distance i
};
// Products of a row pair: blurred a, b, a^2, b^2, ab into the five rows `out`. `scratch`: 5 x stride floats.
void ssimBlurProducts(const SsimRows& s, const float* a, const float* b, float* scratch, float* const out[5]);

struct SsimRowResult {
  double ssim = 0, l1 = 0;
};
// `blurred`: row y of the five planes, rows y-5 ... y+5 readable at distance `stride`. Writes the row-blurred
// derivative maps (sum over pixels of SSIM) into the three rows `out`. `scratch`: 3 x stride floats, zero
// padded.
double ssimRow(const SsimRows& s, const float* const blurred[5], float* scratch, float* const out[3]);
// gradient = l1_scale * sign(a - b) + ssim_scale * dS/da of one row; returns the sum of |a - b|.
double ssimGradientRow(const SsimRows& s, const float* const maps[3], const float* a, const float* b,
                       float l1_scale, float ssim_scale, float* gradient);

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
