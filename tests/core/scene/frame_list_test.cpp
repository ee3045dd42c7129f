// SPDX-License-Identifier: Apache-2.0
#include "core/scene/frame_list.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace beam {
namespace {

std::vector<int> parse(const char* list, std::vector<std::string> frames = {}) {
  if (frames.empty()) {
    for (int i = 0; i < 10; ++i) frames.push_back("00000" + std::to_string(i));
  }
  std::vector<int> positions;
  for (const FrameIndex frame : parseFrameList(list, frames)) positions.push_back(frame.value);
  return positions;
}

TEST(FrameList, UnderstandsRunsSinglesStridesAndAll) {
  EXPECT_EQ(parse("0-3"), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(parse("1,5"), (std::vector<int>{1, 5}));
  EXPECT_EQ(parse("1-9x2"), (std::vector<int>{1, 3, 5, 7, 9}));
  EXPECT_EQ(parse("all").size(), 10u);
  EXPECT_EQ(parse("7"), (std::vector<int>{7}));
}

TEST(FrameList, TakesOpenRangesBlanksAndAnyCase) {
  EXPECT_EQ(parse("7-"), (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(parse("3-x3"), (std::vector<int>{3, 6, 9}));
  EXPECT_EQ(parse(" 1 - 3 , 5 "), (std::vector<int>{1, 2, 3, 5}));
  EXPECT_EQ(parse("1-5X2"), (std::vector<int>{1, 3, 5}));
  EXPECT_EQ(parse("ALL").size(), 10u);
  EXPECT_EQ(parse("8-, 0").size(), 3u);
  EXPECT_TRUE(isAllFrames(" All "));
  EXPECT_FALSE(isAllFrames("all,1"));
}

TEST(FrameList, GivesEachFrameOnceAndInOrder) {
  EXPECT_EQ(parse("5,1-3,2,5"), (std::vector<int>{1, 2, 3, 5}));
}

TEST(FrameList, CountsInTheCapturesOwnNumbers) {
  EXPECT_EQ(parse("12-14", {"frame_0012", "frame_0014", "frame_0020"}), (std::vector<int>{0, 1}));
  EXPECT_EQ(parse("frame_0020", {"frame_0012", "frame_0014", "frame_0020"}), (std::vector<int>{2}));
  EXPECT_EQ(parse("3-9x3", {"003", "005", "006", "009"}), (std::vector<int>{0, 2, 3}));
}

TEST(FrameList, RefusesWhatTheCaptureDoesNotHave) {
  for (const char* list : {"10", "8-12", "99-100", "5,77"}) EXPECT_THROW(parse(list), Error) << list;
  EXPECT_THROW(parse("1-3", {"a", "b"}), Error);
}

TEST(FrameList, RefusesWordsItDoesNotUnderstand) {
  for (const char* list : {"", " ", "a", "-", "-1", "3-1", "1-5x0", "1,,2", "1-5x", "1.5", "1x2", "1 2"}) {
    try {
      parse(list);
      ADD_FAILURE() << "\"" << list << "\" was taken";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), Error::Kind::Usage);
    }
  }
}

TEST(FrameList, IsToldBackAsRanges) {
  EXPECT_EQ(frameRanges({"f3", "f4", "f5", "f9"}, {3, 4, 5, 9}), (std::vector<std::string>{"f3-f5", "f9"}));
  EXPECT_TRUE(frameRanges({}, {}).empty());
}

}  // namespace
}  // namespace beam
