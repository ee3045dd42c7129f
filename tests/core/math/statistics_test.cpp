// SPDX-License-Identifier: Apache-2.0
#include "core/math/statistics.h"

#include <gtest/gtest.h>

#include <numeric>

namespace beam {
namespace {

// 0, 1, ..., count - 1, not in order.
std::vector<int> shuffled(std::size_t count) {
  std::vector<int> v(count);
  std::iota(v.begin(), v.end(), 0);
  std::rotate(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(count / 3), v.end());
  return v;
}

TEST(Statistics, TheMedianOfAnEvenNumberIsTheUpperOfTheTwo) {
  EXPECT_EQ(median(shuffled(7)), 3);
  EXPECT_EQ(median(shuffled(8)), 4);
  EXPECT_EQ(nearestRank(shuffled(8), 0.5), 3);
  EXPECT_EQ(nearestRank(shuffled(7), 0.5), 3);
}

TEST(Statistics, AQuantileHasItsShareBelowRoundedDown) {
  for (const std::size_t n : {1, 2, 19, 20, 21, 100, 101})
    EXPECT_EQ(quantile(shuffled(n), 0.95), static_cast<int>(n * 95 / 100)) << n;
  EXPECT_EQ(quantile(shuffled(10), 0), 0);
  EXPECT_EQ(quantile(shuffled(10), 1), 9);
}

TEST(Statistics, TheNearestRankIsTheSmallestThatItsShareDoesNotExceed) {
  EXPECT_EQ(nearestRank(shuffled(100), 0.95), 94);
  EXPECT_EQ(nearestRank(shuffled(101), 0.95), 95);
  EXPECT_EQ(nearestRank(shuffled(3), 0), 0);
  EXPECT_EQ(nearestRank(shuffled(3), 1), 2);
}

TEST(Statistics, NothingHasAllOfThemAtZero) {
  EXPECT_EQ(median(std::vector<double>()), 0);
  EXPECT_EQ(quantile(std::vector<float>(), 0.9), 0);
  EXPECT_EQ(nearestRank(std::vector<double>(), 0.9), 0);
}

}  // namespace
}  // namespace beam
