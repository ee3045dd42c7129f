// SPDX-License-Identifier: Apache-2.0
// Gaussians as the engine computes on them: one float plane an attribute component, 64-byte aligned, padded
// to 16. A plane layout lets kernels load 16 Gaussians at once and lets the optimiser step over everything in
// one sweep.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/render/aligned.h"
#include "core/scene/gaussian_cloud.h"

namespace beam {

// Planes in order: position 3, rotation 4 (w x y z, need not be unit), scale 3, opacity 1, sh 48 (k * 3 +
// channel), then the extra channels.
struct PlaneLayout {
  static constexpr int kPosition = 0, kRotation = 3, kScale = 7, kOpacity = 10, kSh = 11, kExtra = 59;
};

struct GaussianBuffers {
  std::size_t count = 0;
  std::size_t stride = 0;  // count rounded up to 16
  int extra_channels = 0;
  AlignedVector<float> values;  // [plane][stride]; the padding is zero

  GaussianBuffers() = default;
  explicit GaussianBuffers(std::size_t n, int extra = 0)
      : count(n),
        stride((n + 15) / 16 * 16),
        extra_channels(extra),
        values(stride * (PlaneLayout::kExtra + extra)) {}
  int planes() const { return PlaneLayout::kExtra + extra_channels; }
  float* plane(int p) { return values.data() + stride * p; }
  const float* plane(int p) const { return values.data() + stride * p; }
};

// `values`: `planes` floats a Gaussian, one Gaussian after the other; into `to`, a plane every `stride`
// floats.
void packPlanes(std::span<const float> values, std::size_t planes, std::size_t gaussians, std::size_t stride,
                float* to);
// The cloud's Gaussians into `into` from Gaussian `first` on; its extra channels stay.
void packCloud(const GaussianCloud& cloud, GaussianBuffers& into, std::size_t first);

// Physical values into planes and back. `toCloud` normalises the quaternions.
GaussianBuffers toBuffers(const GaussianCloud& cloud, int extra_channels = 0);
GaussianCloud toCloud(const GaussianBuffers& buffers);

}  // namespace beam
