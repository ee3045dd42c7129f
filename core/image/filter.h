// SPDX-License-Identifier: Apache-2.0
// Filters that look at the surface behind a pixel: where its depth breaks, and the denoiser of ray-traced
// integrals.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/progress.h"
#include "core/image/image.h"

namespace beam {

// 1 where a neighbour (of 4) has alpha < 0.5 or a depth that differs by more than max(0.02 m, 3 x the median
// step of the 3x3 neighbourhood); pixels without depth and the picture's border count as edges (methods 2.6).
Image<std::uint8_t> depthEdges(const Image<float>& depth_m, const Image<float>& alpha);

struct SurfaceGuides {
  const Image<float>& depth_m;
  const Image<float>& alpha;
  const Image<vec3>& normal;  // unit
};

// The mean depth of the surface around a pixel: within `radius` pixels, alpha > 0.9, at most 30 mm away,
// weighted by distance and by how the normals agree. Evens out the steps between Gaussians; keeps 0 where
// there is no depth.
float evenDepth(const SurfaceGuides& surface, int x, int y, int radius);

struct DenoiseGuides {
  Image<vec3> normal;         // unit
  Image<float> depth_m;       // > 0 where valid
  Image<std::uint8_t> valid;  // only these pixels are read and written
};

// A picture of noisy means, 1 or 3 channels, and the variance of (the luminance of) each.
struct NoisySignal {
  Planes values;
  Planes variance;
};

// Edge-avoiding a-trous wavelet filter (Dammertz 2010 with SVGF's weights; methods 5.9): 5x5 B3-spline taps,
// distance 2^level. All signals share the guides. A constant stays as it is; nothing leaks across normals,
// depth or mask. Throws Cancelled when the progress is stopped.
void denoiseATrous(std::span<NoisySignal> signals, const DenoiseGuides& guides, int levels,
                   const Progress& progress = Progress{});

}  // namespace beam
