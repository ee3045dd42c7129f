// SPDX-License-Identifier: Apache-2.0
// Shadow maps on the CPU: Gaussians to ellipses of the light's view, 16 at a time, then bands of rows, each
// Gaussian after Gaussian.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/render/gaussian_buffers.h"
#include "core/render/shadow_drawer.h"

namespace beam {

std::unique_ptr<ShadowDrawer> makeCpuShadowDrawer();

// Of a light's view. exponent (base 2) at d = texel - centre: a dx^2 + b dx dy + c dy^2, drawn where it is
// at least `least`; depth z + slope . d.
struct alignas(16) ShadowSplat {
  float x, y;
  float a, b, c;
  float opacity;  // 0: casts nothing there
  float z, slope_x, slope_y;
  float least;
  float half_width, half_height;  // texels
};

struct ShadowPlanes {
  int size = 0, stride = 0;
  // What is drawn over, without order: the smallest depth, the product of 1 - alpha, the sums of alpha and of
  // alpha z.
  AlignedVector<float> nearest, through, weight, weighted;
};

// SIMD steps. `side`: 1 or -1 a Gaussian, of kNormalSideName; null: unknown, all of them cast.
void castSplats(const GaussianBuffers& gaussians, const float* side, const ShadowView& view,
                std::size_t begin, std::size_t end, ShadowSplat* splats);
void drawSplatRows(const ShadowSplat* splats, std::span<const std::uint32_t> drawn, int begin_row,
                   int end_row, ShadowPlanes& planes);

}  // namespace beam
