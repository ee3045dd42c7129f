// SPDX-License-Identifier: Apache-2.0
// Order statistics. Two definitions are in use, and results hold on to theirs: they differ where a share of
// the values is a whole number of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace beam {

// The value that `share` of all lie below, that number rounded down; 0 where there are none.
template <class T>
T quantile(std::vector<T> values, double share) {
  if (values.empty()) return T{};
  const auto below = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(below, values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Of an even number the upper one of the two in the middle.
template <class T>
T median(std::vector<T> values) {
  return quantile(std::move(values), 0.5);
}

// The smallest value that `share` of all do not exceed; 0 where there are none.
template <class T>
T nearestRank(std::vector<T> values, double share) {
  if (values.empty()) return T{};
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace beam
