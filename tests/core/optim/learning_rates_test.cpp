// SPDX-License-Identifier: Apache-2.0
// Laws of the learning rates: where they begin, how they fall, where they end.
#include "core/optim/learning_rates.h"

#include <gtest/gtest.h>

namespace beam {
namespace {

TEST(LearningRates, BeginAtTheTableAndEndAtTheirShareOfIt) {
  for (const ModelRates& table : {kFirstFrameRates, kLaterFrameRates, kShadingRates}) {
    const LearningRates first = ratesAt(table, 0, 200, 3), last = ratesAt(table, 200, 200, 3);
    EXPECT_FLOAT_EQ(first.position_m, static_cast<float>(3 * table.position));
    EXPECT_FLOAT_EQ(first.rotation, static_cast<float>(table.rotation));
    EXPECT_FLOAT_EQ(first.log_scale, static_cast<float>(table.log_scale));
    EXPECT_FLOAT_EQ(first.opacity_logit, static_cast<float>(table.opacity_logit));
    EXPECT_FLOAT_EQ(first.color_dc, static_cast<float>(table.color));
    EXPECT_FLOAT_EQ(first.color_rest * table.rest_divisor, first.color_dc);
    EXPECT_FLOAT_EQ(last.position_m, first.position_m * static_cast<float>(table.position_last));
    EXPECT_FLOAT_EQ(last.log_scale, first.log_scale * static_cast<float>(table.last));
    EXPECT_FLOAT_EQ(last.color_rest, first.color_rest * static_cast<float>(table.last));
  }
}

TEST(LearningRates, FallByTheSameFactorEveryStepAndNoFurtherThanTheEnd) {
  const float step = shareAt(0.1, 1, 50);
  EXPECT_LT(step, 1);
  for (int i = 1; i <= 50; ++i) EXPECT_NEAR(shareAt(0.1, i, 50) / shareAt(0.1, i - 1, 50), step, 1e-5f);
  EXPECT_EQ(shareAt(0.1, 60, 50), shareAt(0.1, 50, 50));
  EXPECT_EQ(shareAt(1, 17, 50), 1.0f);
}

TEST(LearningRates, OfALaterFrameLeaveItsGaussiansToTheJoints) {
  const LearningRates r = ratesAt(kLaterFrameRates, 0, 1, 5);
  EXPECT_EQ(r.position_m, 0);
  EXPECT_EQ(r.rotation, 0);
}

}  // namespace
}  // namespace beam
