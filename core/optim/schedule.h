// SPDX-License-Identifier: Apache-2.0
// Learning rates over the steps of a fit, and the order in which views are drawn.
#pragma once

#include <cmath>
#include <numeric>
#include <vector>

#include "core/base/rng.h"

namespace beam {

// Log-linear from `first` at step 0 to `last` at step `steps` (methods 1.11).
inline double logLinear(double first, double last, int step, int steps) {
  const double t = steps > 0 ? std::min(1.0, static_cast<double>(step) / steps) : 1.0;
  return std::exp(std::log(first) * (1 - t) + std::log(last) * t);
}

// The view of a step when views are drawn without replacement, one shuffle an epoch (methods 1.11).
inline std::size_t viewOfStep(int step, std::size_t views, std::uint64_t seed) {
  const auto epoch = static_cast<std::uint64_t>(step) / views;
  std::vector<std::size_t> order(views);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const RandomStream random(seed, epoch, 0x71e8u);
  for (std::size_t i = views; i > 1; --i) std::swap(order[i - 1], order[random.below(i, i)]);
  return order[static_cast<std::size_t>(step) % views];
}

}  // namespace beam
