// SPDX-License-Identifier: Apache-2.0
// Drift and flicker of a take: does a Gaussian stay on the point of the skin where it started, and does what
// is constant look constant. Drift needs true tracks, flicker along Gaussians needs nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/gbuffer.h"

namespace beam {

// Points of the true skin in one frame, world axes, the same order in all frames.
struct TrueSkin {
  std::vector<vec3> position_m;
  std::vector<vec3> normal;  // unit
};

struct Spread {
  double median = 0, p95 = 0;  // 95th percentile: the smallest value that 95 % do not exceed
};
Spread spreadOf(std::vector<double> values);  // zeros for none

// Of every Gaussian of the take's first frame the index of its nearest true point; kNoPoint further than
// `most_m` away: not of the skin.
inline constexpr std::uint32_t kNoPoint = ~0u;
std::vector<std::uint32_t> nearestPoints(const GaussianCloud& first, const TrueSkin& truth,
                                         double most_m = 0.03);

// Millimetres |x_t - (p_t + R (x_0 - p_0))| over the Gaussians with a point: x Gaussian, p its true point, R
// how the skin around it turned: it takes the point's normal of the first frame to that of frame t and fits
// the 12 true points nearest in the first frame best. (A turn of the normal alone leaves the twist about it
// open: after half a turn of the body that is as much as the spacing of the points.)
Spread drift_mm(const GaussianCloud& first, const GaussianCloud& now, const TrueSkin& first_truth,
                const TrueSkin& truth, std::span<const std::uint32_t> nearest);

// Whether `now` is `before` moved on: the same number of Gaussians, and the median way of a Gaussian is below
// a quarter of the cloud's root mean square radius (frames that were fitted alone share no order).
bool isTracked(const GaussianCloud& before, const GaussianCloud& now);

// Mean over Gaussians, weighted by opacity, of the mean absolute change of the channels of the direction-free
// colour (SH degree 0): radiance sRGB-encoded, base colour linear, both in [0, 1].
double radianceFlicker(const GaussianCloud& before, const GaussianCloud& now);
double baseColorFlicker(const GaussianCloud& before, const Materials& before_materials,
                        const Materials& now_materials);

// What a view shows of the true points (front-facing, inside the picture, depth within `most_m` of the
// rendered depth at its pixel): the values there, between pixels, divided by alpha. (The nearest pixel is up
// to half a pixel off in both frames: texture would count as flicker.)
struct SeenPoints {
  std::vector<std::uint8_t> seen;  // a point each
  std::vector<vec3> radiance,
      base_color;  // of points that are not seen: 0; base_color: empty without materials
};
SeenPoints seenPoints(const GBuffer& view, const Camera& camera, const TrueSkin& truth, double most_m = 0.01);

// The same in one view, along true points that both frames show: mean absolute change of the values. Nothing
// where fewer than 50 points are seen.
struct ViewFlicker {
  double radiance = 0, base_color = 0;  // base_color: 0 without materials
  std::size_t points = 0;
};
std::optional<ViewFlicker> viewFlicker(const SeenPoints& before, const SeenPoints& now);

}  // namespace beam
