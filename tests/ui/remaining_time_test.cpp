// SPDX-License-Identifier: Apache-2.0
// Laws of the time that is left: it falls while a run goes as expected, it follows when it does not, and what
// it says holds the truth.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ui/remaining_time.h"
#include "ui/run_forecast.h"

namespace beam {
namespace {

TEST(RemainingTime, SaysThatItEstimatesUntilThereIsAnEstimate) {
  RemainingTime time;
  EXPECT_FALSE(time.known());
  EXPECT_EQ(time.text().toStdString(), "estimating the time");
  time.feed(1, -1, 0);
  EXPECT_EQ(time.text().toStdString(), "estimating the time");
  time.feed(2, 100, 0.02);
  EXPECT_TRUE(time.known());
  time.start();
  EXPECT_FALSE(time.known()) << "another run knows nothing of the last one";
}

TEST(RemainingTime, UpperEndNeverRisesWhileEstimatesStayInItsRange) {
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> noise(0.9, 1.1);
    RemainingTime time;
    constexpr double kTotal_s = 600;
    double high = INFINITY;
    for (double t = 2; t < kTotal_s; t += 0.25) {
      time.feed(t, (kTotal_s - t) * noise(random), t / kTotal_s);
      EXPECT_LE(time.high_s(), high + 1e-9) << "at " << t << " of seed " << seed;
      EXPECT_LE(time.low_s(), time.high_s());
      high = time.high_s();
    }
    EXPECT_LT(high, 5);
  }
}

TEST(RemainingTime, HoldsTheTruthWhereEstimatesAreRight) {
  RemainingTime time;
  for (double t = 1; t < 1000; t += 1) {
    time.feed(t, 1000 - t, t / 1000);
    EXPECT_LE(time.low_s(), 1000 - t);
    EXPECT_GE(time.high_s(), 1000 - t);
  }
}

TEST(RemainingTime, AShortSpikeOfTheEstimateChangesNothing) {
  RemainingTime time;
  time.feed(10, 100, 0.1);
  const double low_end = time.low_s() + 10, high_end = time.high_s() + 10;
  for (double t = 11; t < 14; t += 0.5) time.feed(t, 1000, 0.1);
  EXPECT_NEAR(time.high_s() + 13.5, high_end, 1e-9);
  EXPECT_NEAR(time.low_s() + 13.5, low_end, 1e-9);
  time.feed(14, 96, 0.14);
  EXPECT_LE(time.high_s() + 14, high_end);
}

TEST(RemainingTime, FollowsAnEstimateThatStaysOutside) {
  for (const double left : {1000.0, 20.0}) {
    RemainingTime time;
    time.feed(10, 200, 0.1);
    for (double t = 11; t < 20; t += 0.5) time.feed(t, left, 0.1);
    EXPECT_LE(time.low_s(), left);
    EXPECT_GE(time.high_s(), left);
  }
}

// The run that a person watched: 2:46, then 3:49, then 4:19 left. One step up, no more.
TEST(RemainingTime, AnEstimateThatCreepsUpMovesItSeldom) {
  RemainingTime time;
  int rises = 0;
  double high_end = INFINITY;
  for (double t = 10; t < 250; t += 0.1) {
    const double left = std::min(166 + 0.6 * (t - 10), 259.0);
    time.feed(t, left, t / (t + left));
    if (std::isfinite(high_end) && time.high_s() + t > high_end + 1e-6) ++rises;
    high_end = time.high_s() + t;
  }
  EXPECT_LE(rises, 3) << "the estimate itself rose a thousand times";
}

TEST(RemainingTime, RoundsOutwardAndCoarserTheLongerItIs) {
  const auto text = [](double low, double high) { return rangeText(low, high).toStdString(); };
  EXPECT_EQ(text(170, 290), "2 to 5 min");
  EXPECT_EQ(text(180, 300), "3 to 5 min");
  EXPECT_EQ(text(20, 110), "up to 2 min");
  EXPECT_EQ(text(250, 290), "4 to 5 min");
  EXPECT_EQ(text(300, 300), "about 5 min");
  EXPECT_EQ(text(1000, 1900), "15 to 35 min");
  EXPECT_EQ(text(3000, 5000), "0.5 to 1.5 h");
  EXPECT_EQ(text(8 * 3600, 11.2 * 3600), "8 to 12 h");
}

TEST(RemainingTime, WordsOfTheUpperEndNeverRiseAsItFalls) {
  const auto minutes = [](double high) {
    const QString text = rangeText(0, high);  // "up to 5 min"
    const double n = text.section(' ', 2, 2).toDouble();
    return text.endsWith(" h") ? 60 * n : n;
  };
  double before = INFINITY;
  for (double high = 40 * 3600; high > 0; high -= 7) {
    EXPECT_LE(minutes(high), before) << high;
    EXPECT_GE(minutes(high) * 60, high - 1) << "rounded outward";
    before = minutes(high);
  }
}

TEST(RemainingTime, UpperEndIsNeverBelowWhatACounterSays) {
  RemainingTime time;
  for (double t = 1; t < 10; t += 1) time.feed(t, 20, 0.01);
  EXPECT_EQ(time.text().toStdString(), "less than a minute left");
  time.feed(10, 460, 0.02, {400, 900, 450});
  EXPECT_GE(time.high_s(), 450) << "at once";
  EXPECT_LE(time.low_s(), 460);
  double high = time.high_s();
  for (double t = 11; t < 459; t += 1) {
    time.feed(t, 470 - t, 0.02 + 0.001 * t, {460 - t, 900 - t, 460 - t});
    ASSERT_GE(time.high_s(), 460 - t);
    EXPECT_LE(time.high_s(), high) << t;
    high = time.high_s();
  }
}

TEST(RemainingTime, IsAsWideAsItsBounds) {
  RemainingTime time;
  time.feed(1, 100, 0.9, {20, 400});
  EXPECT_LE(time.low_s(), 20);
  EXPECT_GE(time.high_s(), 400);
  time.feed(2, 99, 0.9, {80, 120});
  EXPECT_GE(time.low_s(), 75);
  EXPECT_LE(time.high_s(), 121);
}

TEST(RunForecast, SaysHowLongInWordsOfOneKind) {
  const auto text = [](double low, double high) {
    return forecastText({1, 1, 5, 9, low, high, true}).toStdString();
  };
  EXPECT_EQ(text(5, 40), "1 frame: 5 steps missing, up to 1 min");
  EXPECT_EQ(text(150, 180), "1 frame: 5 steps missing, 2 to 3 min");
  EXPECT_EQ(text(180, 180), "1 frame: 5 steps missing, about 3 min");
}

TEST(RemainingTime, EndsInLessThanAMinute) {
  RemainingTime time;
  time.feed(100, 20, 0.9);
  EXPECT_EQ(time.text().toStdString(), "less than a minute left");
}

}  // namespace
}  // namespace beam
