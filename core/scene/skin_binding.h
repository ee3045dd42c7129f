// SPDX-License-Identifier: Apache-2.0
// The few weighted neighbours that a point hangs on; of a skin Gaussian its joints (BEAM 3.1, Appendix A).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace beam {

// Point i hangs on targets [i * per_point, (i + 1) * per_point), nearest first; its weights sum to 1.
struct SkinBinding {
  int per_point = 0;
  std::vector<std::uint32_t> target;
  std::vector<float> weight;

  std::size_t points() const { return per_point ? target.size() / static_cast<std::size_t>(per_point) : 0; }
  bool operator==(const SkinBinding&) const = default;
};

}  // namespace beam
