// SPDX-License-Identifier: Apache-2.0
// Gaussians prepared for rays: canonical transform, cut, and a box around the cut. What every tracer of the
// CPU device is built from, so that all of them sum the same numbers.
#pragma once

#include <cstdint>
#include <vector>

#include "core/render/tracer.h"

namespace beam {

struct RaySplat {
  float canonical[9];  // S^-1 R^T, rows
  vec3 center;
  float opacity, cut2;  // cut2: squared radius of the cut in standard deviations, > 0
  vec3 low, high;       // box of the cut ellipsoid and the margin around it
  float margin_m;       // covers the rounding of rays that start within 30 scene sizes
};

// The Gaussians that can be met, in the order of the cloud. Throws Error{Bug} when the description is
// nonsense.
std::vector<RaySplat> raySplats(const TracerDesc& desc, const GaussianCloud& cloud);

// Their indices in the cloud.
std::vector<std::uint32_t> metSplats(const TracerDesc& desc, const GaussianCloud& cloud);

// Whether a ray of this chance ends in the Gaussian (Tracer::drawn). `units`: its alpha in 1 / kAlphaUnits.
bool endsIn(std::uint32_t splat, float units, std::uint64_t draw);
// -ln(1 - alpha) in units of 2^-20, whole: sums do not depend on their order.
std::uint64_t absorbanceUnits(float units);
// Of a sum of these; 0 above kOpaqueUnits.
inline constexpr std::uint64_t kOpaqueUnits = 7268408;  // ln(1024)
float transmittanceOf(std::uint64_t absorbance_units);

// The largest whole sum of alphas that does not block.
std::uint64_t freeAlphaUnits(const TracerDesc& desc);

}  // namespace beam
