// SPDX-License-Identifier: Apache-2.0
// Growth by MCMC (methods 1.12): nearly transparent Gaussians move onto opaque ones, and the count grows to a
// cap.
#pragma once

#include <cstdint>

#include "core/optim/gaussian_model.h"

namespace beam {

// Moves Gaussians of opacity <= 0.005 onto others drawn with probability proportional to opacity. Returns how
// many.
std::size_t relocateDead(GaussianModel& model, std::uint64_t seed, int step);

// Grows the count by `factor`, at most to `cap`, by the same rule. Returns how many came.
std::size_t grow(GaussianModel& model, double factor, std::size_t cap, std::uint64_t seed, int step);

}  // namespace beam
