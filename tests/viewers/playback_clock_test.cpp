// SPDX-License-Identifier: Apache-2.0
#include "viewers/playback_clock.h"

#include <gtest/gtest.h>

namespace beam {
namespace {

PlaybackClock clockOf(int frames, double fps) {
  PlaybackClock clock;
  clock.setTake(frames, fps);
  return clock;
}

TEST(PlaybackClock, ClampsInAndOutIntoTheTakeAndKeepsThemInOrder) {
  PlaybackClock clock = clockOf(10, 30);
  EXPECT_EQ(clock.range(), (FrameRange{0, 9}));
  clock.setIn(-4);
  clock.setOut(99);
  EXPECT_EQ(clock.range(), (FrameRange{0, 9}));
  clock.setIn(3);
  clock.setOut(6);
  EXPECT_EQ(clock.range(), (FrameRange{3, 6}));
  clock.setIn(8);  // beyond the out point: the range goes on to the end
  EXPECT_EQ(clock.range(), (FrameRange{8, 9}));
  clock.setOut(2);  // before the in point: from the start
  EXPECT_EQ(clock.range(), (FrameRange{0, 2}));
  EXPECT_FALSE(clock.wholeTake());
  clock.clearRange();
  EXPECT_TRUE(clock.wholeTake());
}

TEST(PlaybackClock, TakesAnEmptyTakeAndARateThatIsNone) {
  PlaybackClock clock = clockOf(0, 0);
  EXPECT_EQ(clock.takeRate(), 30);
  clock.setIn(3);
  clock.setOut(3);
  clock.setTake(0, 24);
  clock.start(0, 1);
  EXPECT_FALSE(clock.playing());
}

TEST(PlaybackClock, IsDueAtTheTakesRateAndLoopsInsideTheRange) {
  PlaybackClock clock = clockOf(100, 25);
  clock.setIn(10);
  clock.setOut(19);
  clock.start(18, 5.0);
  EXPECT_EQ(clock.frameAt(5.0), 18);
  EXPECT_EQ(clock.frameAt(5.039), 18);
  EXPECT_EQ(clock.frameAt(5.04), 19);
  EXPECT_EQ(clock.frameAt(5.08), 10);
  EXPECT_EQ(clock.frameAt(5.08 + 0.4), 10) << "once around is 10 frames";
  EXPECT_TRUE(clock.playing());
}

TEST(PlaybackClock, StartsAtTheInPointFromOutsideAndFromTheEnd) {
  PlaybackClock clock = clockOf(100, 25);
  clock.setIn(10);
  clock.setOut(19);
  clock.start(50, 0);
  EXPECT_EQ(clock.frameAt(0), 10);
  clock.setLoop(false);
  clock.start(19, 0);
  EXPECT_EQ(clock.frameAt(0), 10);
}

TEST(PlaybackClock, WithoutALoopStopsAfterTheOutPoint) {
  PlaybackClock clock = clockOf(5, 10);
  clock.setLoop(false);
  clock.start(3, 0);
  EXPECT_EQ(clock.frameAt(0.15), 4);
  EXPECT_TRUE(clock.playing()) << "the out point has its full time";
  EXPECT_EQ(clock.frameAt(0.21), 4);
  EXPECT_FALSE(clock.playing());
}

// Pictures that take 0.1 s each at 30 frames a second.
TEST(PlaybackClock, LeavesOutFramesRatherThanSlowingDownAndSaysTheRateReached) {
  PlaybackClock clock = clockOf(1000, 30);
  clock.start(0, 0);
  EXPECT_EQ(clock.rate(), 0) << "nothing to say yet";
  int frame = 0;
  for (int i = 1; i <= 20; ++i) {
    frame = clock.frameAt(0.1 * (i - 1));
    clock.shown(0.1 * i);
  }
  EXPECT_EQ(frame, 57) << "as many frames on as time went by";
  EXPECT_NEAR(clock.rate(), 10, 1e-6);
  EXPECT_EQ(clock.dropped(), 57 - 19);
}

TEST(PlaybackClock, ReachesTheRateWhenPicturesAreInTime) {
  PlaybackClock clock = clockOf(1000, 24);
  clock.start(0, 0);
  for (int i = 0; i < 48; ++i) {
    clock.frameAt(i / 24.0);
    clock.shown(i / 24.0 + 0.01);
    clock.shown(i / 24.0 + 0.02);  // the same frame drawn again does not count
  }
  EXPECT_NEAR(clock.rate(), 24, 1e-6);
  EXPECT_EQ(clock.dropped(), 0);
}

TEST(PlaybackClock, ForgetsTheRateOfLongAgo) {
  PlaybackClock clock = clockOf(1000, 30);
  clock.start(0, 0);
  for (int i = 0; i < 100; ++i) {
    clock.frameAt(i / 30.0);
    clock.shown(i / 30.0);
  }
  for (int i = 0; i < 30; ++i) {
    clock.frameAt(4 + i / 10.0);
    clock.shown(4 + i / 10.0);
  }
  EXPECT_NEAR(clock.rate(), 10, 1e-6);
}

TEST(PlaybackClock, FollowsARangeThatChangesWhilePlaying) {
  PlaybackClock clock = clockOf(100, 10);
  clock.start(0, 0);
  EXPECT_EQ(clock.frameAt(1), 10);
  clock.setIn(40);
  const int frame = clock.frameAt(1.1);
  EXPECT_TRUE(clock.range().contains(frame)) << frame;
}

TEST(PlayDivisor, IsTheLargestPictureThatKeepsUp) {
  EXPECT_EQ(playDivisor(20, 8, 33.3), 1);
  EXPECT_EQ(playDivisor(33, 12, 33.3), 2) << "no time would be left to show it";
  EXPECT_EQ(playDivisor(100, 25, 33.3), 2);
  EXPECT_EQ(playDivisor(100, 32, 33.3), 4);
  EXPECT_EQ(playDivisor(9000, 2000, 33.3), 4) << "and no smaller";
}

}  // namespace
}  // namespace beam
