// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/takes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Takes = std::vector<Take>;

Take take(int first, int last, int step = 1, int lead = 0) { return {{first}, {last}, step, lead}; }
Take cutOff(Take take) {
  take.cut = true;
  return take;
}
Take withoutSomeOfItsLead(Take take, int lost) {
  take.lost_lead = lost;
  return take;
}

std::vector<FrameIndex> framesOf(std::initializer_list<int> numbers) {
  std::vector<FrameIndex> frames;
  for (const int n : numbers) frames.push_back({n});
  return frames;
}

TEST(Takes, TheLastTakeThatHoldsAFrameOwnsIt) {
  const Takes takes = {take(0, 9), take(4, 6), take(0, 8, 4)};
  EXPECT_EQ(takeOf(takes, {3}), take(0, 9));
  EXPECT_EQ(takeOf(takes, {5}), take(4, 6));
  EXPECT_EQ(takeOf(takes, {4}), take(0, 8, 4));
  EXPECT_EQ(takeOf(takes, {12}), take(12, 12));
}

TEST(Takes, TheFrameBeforeIsOneStrideAwayAndTheFirstHasNone) {
  EXPECT_EQ(take(2, 10, 4).before({6}), FrameIndex{2});
  EXPECT_FALSE(take(2, 10, 4).before({2}));
  EXPECT_EQ(take(2, 10, 4).count(), 3);
}

TEST(Takes, AFrameLiesBetweenMembersOfATakeWithAStrideThatOwnsThem) {
  const Takes scout = {take(0, 3), take(0, 8, 4)};
  EXPECT_EQ(betweenOf(scout, {1}), (Between{{0}, {4}, 0.25}));
  EXPECT_EQ(betweenOf(scout, {6}), (Between{{4}, {8}, 0.5}));
  for (const int member_or_outside : {0, 4, 8, 9}) EXPECT_FALSE(betweenOf(scout, {member_or_outside}));
  EXPECT_FALSE(betweenOf({take(0, 8, 4), take(4, 6)}, {2})) << "frame 4 is of another take";
  EXPECT_TRUE(betweenOf({take(0, 8, 4), take(2, 2)}, {2}));
  EXPECT_FALSE(betweenOf({take(0, 8)}, {2}));
}

TEST(Takes, NamedFramesMakeATakeOfEachConsecutiveRun) {
  EXPECT_THAT(takesOfFrames(framesOf({0, 1, 2, 5, 8, 9}), 1),
              ElementsAre(take(0, 2), take(5, 5), take(8, 9)));
  EXPECT_THAT(takesOfFrames(framesOf({0, 1, 2, 3, 4, 5, 9}), 2), ElementsAre(take(0, 4, 2), take(9, 9)));
  EXPECT_THAT(takesOfFrames({}, 1), IsEmpty());
}

TEST(Takes, ANamedTakeGoesToTheEndAndDropsWhatItCovers) {
  EXPECT_EQ(addTake({take(0, 2), take(5, 5), take(2, 6)}, take(0, 5)), (Takes{take(2, 6), take(0, 5)}));
  EXPECT_EQ(addTake({take(0, 9)}, take(5, 5)), (Takes{take(0, 9), take(5, 5)}));
  EXPECT_EQ(addTake({take(0, 9), take(5, 5)}, take(0, 9)), (Takes{take(0, 9)}));
  EXPECT_EQ(addTake({take(0, 8, 4), take(4, 4), take(0, 4)}, take(0, 9, 2)),
            (Takes{take(0, 4), take(0, 8, 2)}));
}

TEST(Takes, AskingAgainForTheOwnerChangesNothing) {
  const Takes takes = {take(0, 4), take(6, 9)};
  EXPECT_EQ(addTake(takes, take(0, 4)), takes);
  EXPECT_EQ(addTake(takes, take(5, 5)), takes) << "a frame in no take is a take of its own";
}

TEST(Takes, AWholeRunCutsNewStretchesIntoSegments) {
  EXPECT_EQ(joinTakes({}, 120, 50, 0), (Takes{take(0, 49), take(50, 99), take(100, 119)}));
  EXPECT_EQ(joinTakes({}, 120, 0, 0), (Takes{take(0, 119)}));
  EXPECT_EQ(joinTakes({}, 51, 50, 0), (Takes{take(0, 49)})) << "the last one stands alone";
  EXPECT_THAT(joinTakes({}, 1, 50, 0), IsEmpty());
  EXPECT_THAT(joinTakes({}, 9, 1, 0), IsEmpty());
}

TEST(Takes, AWholeRunKeepsSegmentsAndLengthensTheOneBeforeAGap) {
  EXPECT_EQ(joinTakes({take(0, 24), take(60, 69)}, 100, 50, 0),
            (Takes{take(0, 49), take(60, 99), take(50, 59)}));
  EXPECT_EQ(joinTakes({take(10, 14)}, 20, 50, 0), (Takes{take(10, 19), take(0, 9)}));
  EXPECT_EQ(joinTakes({take(0, 79)}, 100, 50, 0), (Takes{take(0, 79), take(80, 99)})) << "long ones stay";
  EXPECT_EQ(joinTakes({take(0, 4)}, 10, 0, 0), (Takes{take(0, 9)}));
}

TEST(Takes, AWholeRunDropsLoneInnerAndScoutTakes) {
  EXPECT_EQ(joinTakes({take(0, 9), take(3, 3), take(4, 6), take(0, 8, 4)}, 10, 50, 0), (Takes{take(0, 9)}));
  EXPECT_EQ(joinTakes({take(4, 6), take(0, 9), take(0, 9)}, 10, 50, 0), (Takes{take(0, 9)}));
  EXPECT_EQ(joinTakes({take(2, 5), take(0, 3), take(3, 6)}, 7, 50, 0), (Takes{take(0, 3), take(3, 6)}))
      << "one that owns no frame any more";
}

TEST(Takes, JoiningTwiceIsJoiningOnce) {
  for (const Takes& list : {Takes{}, Takes{take(7, 7)}, Takes{take(5, 14), take(0, 9)}, Takes{take(3, 30)}}) {
    for (const int segment : {0, 1, 7, 50}) {
      for (const int overlap : {0, 2}) {
        const Takes once = joinTakes(list, 60, segment, overlap);
        EXPECT_EQ(joinTakes(once, 60, segment, overlap), once);
      }
    }
  }
}

TEST(Takes, ALeadIsBuiltOnAndBelongsToOthers) {
  const Take second = withLead(take(10, 19), 2);
  EXPECT_EQ(second, take(8, 19, 1, 2));
  EXPECT_EQ(withLead(take(1, 5), 3), take(0, 5, 1, 1)) << "as far as there are frames";
  EXPECT_EQ(withLead(take(10, 20, 5), 2), take(10, 20, 5));
  EXPECT_EQ(second.begin(), FrameIndex{10});
  EXPECT_EQ(second.before({10}), FrameIndex{9});
  EXPECT_TRUE(second.holds({9}) && !second.claims({9}));
  const Takes takes = {take(0, 9), second};
  EXPECT_EQ(takeOf(takes, {9}), take(0, 9));
  EXPECT_EQ(takeOf(takes, {10}), second);
  EXPECT_EQ(takeOf({second}, {9}), take(9, 9)) << "nobody's";
  EXPECT_EQ(addTake(takes, second), takes);
  EXPECT_EQ(addTake({take(8, 19), take(3, 8)}, second), (Takes{take(8, 19), take(3, 8), second}));
  EXPECT_EQ(addTake({take(10, 12)}, second), (Takes{second}));
}

TEST(Takes, SegmentsOfAWholeRunOverlap) {
  EXPECT_EQ(joinTakes({}, 101, 50, 2), (Takes{take(0, 49), take(48, 99, 1, 2), take(98, 100, 1, 2)}));
  EXPECT_EQ(joinTakes({take(0, 9), take(8, 19, 1, 2)}, 30, 15, 2),
            (Takes{take(0, 9), take(8, 24, 1, 2), take(23, 29, 1, 2)}))
      << "a lead is not of the length";
  EXPECT_EQ(joinTakes({take(8, 19, 1, 2)}, 20, 50, 2), (Takes{take(8, 19, 1, 2), take(0, 9)}));
}

TEST(Takes, ASplitMakesTheFrameAFirstOne) {
  EXPECT_EQ(splitTake({take(0, 9), take(20, 29)}, take(0, 9), {4}),
            (Takes{take(0, 3), cutOff(take(4, 9)), take(20, 29)}));
  EXPECT_EQ(splitTake({take(0, 8, 4)}, take(0, 8, 4), {8}), (Takes{take(0, 4, 4), cutOff(take(8, 8, 4))}));
  EXPECT_EQ(splitTake({take(0, 9)}, take(0, 9), {0}), (Takes{take(0, 9)}));
  EXPECT_EQ(splitTake({take(0, 9)}, take(0, 9), {12}), (Takes{take(0, 9)}));
  EXPECT_EQ(splitTake({take(0, 5)}, take(0, 9), {3}), (Takes{take(0, 5)})) << "another has changed it";
  const Take led = take(8, 19, 1, 2);
  EXPECT_EQ(splitTake({led}, led, {9}), (Takes{withoutSomeOfItsLead(take(9, 19, 1, 1), 1)}));
  EXPECT_EQ(splitTake({led}, led, {10}), (Takes{withoutSomeOfItsLead(take(10, 19), 2)}));
  EXPECT_EQ(splitTake({led}, led, {12}), (Takes{take(8, 11, 1, 2), cutOff(take(12, 19))}));
}

TEST(Takes, WhatWasSplitIsPutBack) {
  for (const Take& whole : {take(0, 9), take(0, 8, 4), take(8, 19, 1, 2), take(8, 19, 1, 3)}) {
    const std::vector<FrameIndex> members = whole.frames();
    for (std::size_t a = 1; a < members.size(); ++a) {
      const Takes once = splitTake({take(0, 7), whole}, whole, members[a]);
      EXPECT_EQ(healed(once), (Takes{take(0, 7), whole})) << members[a].value;
      for (std::size_t b = a + 1; b < members.size(); ++b)
        EXPECT_EQ(healed(splitTake(once, once.back(), members[b])), (Takes{take(0, 7), whole}))
            << members[a].value << " and " << members[b].value;
    }
  }
  EXPECT_EQ(healed({take(0, 3), cutOff(take(4, 9)), take(3, 3)}), (Takes{take(0, 9), take(3, 3)}))
      << "another owns the frame before meanwhile";
  EXPECT_EQ(healed({cutOff(take(4, 9)), take(0, 6, 3)}), (Takes{cutOff(take(4, 9)), take(0, 6, 3)}))
      << "what it was cut from is not there";
  EXPECT_EQ(healed({cutOff(take(4, 9)), take(3, 3)}), (Takes{take(3, 9)}));
  EXPECT_EQ(healed({cutOff(take(4, 9))}), (Takes{take(3, 9)})) << "the frame before is alone";
  EXPECT_EQ(joinTakes({take(0, 3), cutOff(take(4, 9))}, 12, 50, 0), (Takes{take(0, 11)}));
}

TEST(Takes, ThoseThatLoseFramesAreEarlierOnes) {
  EXPECT_EQ(withEarlier({}, {take(0, 8, 4), take(9, 11)}, {take(0, 9), take(9, 11)}), (Takes{take(0, 8, 4)}));
  EXPECT_EQ(withEarlier({take(0, 8, 2), take(0, 9)}, {take(0, 8, 4)}, {take(0, 9)}),
            (Takes{take(0, 8, 2), take(0, 8, 4)}))
      << "one that is back is none";
  Takes many;
  for (int i = 1; i < 400; ++i) many = withEarlier(many, {take(0, i)}, {take(0, i + 1)});
  EXPECT_EQ(many.size(), kMostEarlierTakes);
  EXPECT_EQ(many.back(), take(0, 399));
}

TEST(Takes, AreKeptByTheNamesOfTheirFrames) {
  const std::vector<std::string> frames = {"f02", "f04", "f06", "f08"};
  const Takes takes = {take(0, 3), take(1, 3, 2), take(1, 3, 1, 2)};
  const std::vector<SavedTake> saved = saveTakes(takes, frames);
  EXPECT_EQ(saved, (std::vector<SavedTake>{{"f02", "f08", 1}, {"f04", "f08", 2}, {"f04", "f08", 1, 2}}));
  EXPECT_EQ(readTakes(saved, frames), takes);
  EXPECT_THAT(
      readTakes({{"f02", "f99", 1}, {"f08", "f02", 1}, {"f02", "f08", 0}, {"f02", "f04", 1, 2}}, frames),
      IsEmpty());
}

}  // namespace
}  // namespace beam::testing
