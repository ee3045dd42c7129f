// SPDX-License-Identifier: Apache-2.0
// The photographs of a frame: which are taken, what becomes of those that cannot be read, and smaller ones.
#include "core/scene/frame_views.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <set>

#include "core/base/error.h"
#include "core/base/log.h"

namespace beam {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kWidth = 12, kHeight = 8;

// Every pixel tells camera and place. What is in `torn` cannot be read, what is in `absent` is not there.
struct Pictures final : FrameSource {
  std::set<int> torn, torn_masks, absent;
  std::function<void()> fault;  // of camera 2
  bool masks = true;

  bool has(ViewIndex view, FrameIndex) const override { return !absent.contains(view.value); }
  Image<u8vec3> photo(ViewIndex view, FrameIndex) const override {
    if (fault && view.value == 2) fault();
    if (torn.contains(view.value))
      throw Error(Error::Kind::Data, fmt::format("picture {} is torn", view.value));
    Image<u8vec3> photo(kWidth, kHeight, u8vec3(0), Encoding::Srgb);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) photo(x, y) = u8vec3(view.value, 10 * x, 20 * y);
    }
    return photo;
  }
  Image<std::uint8_t> mask(ViewIndex view, FrameIndex) const override {
    if (torn_masks.contains(view.value))
      throw Error(Error::Kind::Data, fmt::format("mask {} is torn", view.value));
    if (!masks) return {};
    Image<std::uint8_t> mask(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) mask(x, y) = x < 5 ? 255 : 0;
    }
    return mask;
  }
};

class FrameViews : public ::testing::Test {
 protected:
  FrameViews() {
    for (int v = 0; v < 5; ++v) {
      capture.views.push_back({fmt::format("cam{}", v),
                               {{40, 40, 6, 4}, kWidth, kHeight, {}},
                               v == 3 ? Split::Test : Split::Train});
    }
    capture.frames = {"000007"};
    capture.source = pictures;
    sink = addLogSink([this](const LogRecord& r) { said.push_back(r.text); });
  }
  ~FrameViews() override { removeLogSink(sink); }

  std::vector<FrameView> load(Split split = Split::Train, int downscale = 1) const {
    return loadFrameViews(capture, {0}, split, downscale, Progress());
  }
  std::vector<std::string> names(Split split = Split::Train) const {
    std::vector<std::string> out;
    for (const FrameView& v : load(split)) out.push_back(v.name);
    return out;
  }

  std::shared_ptr<Pictures> pictures = std::make_shared<Pictures>();
  CaptureSet capture;
  std::vector<std::string> said;
  int sink = 0;
};

TEST_F(FrameViews, AreThoseOfTheSplitInTheirOrder) {
  EXPECT_THAT(names(), ElementsAre("cam0", "cam1", "cam2", "cam4"));
  EXPECT_THAT(names(Split::Test), ElementsAre("cam3"));
  EXPECT_TRUE(said.empty());
  const FrameView last = load().back();
  EXPECT_EQ(last.photo(2, 3), u8vec3(4, 20, 60));
  EXPECT_EQ(last.mask(4, 0), 255);
  EXPECT_EQ(last.mask(5, 0), 0);
}

TEST_F(FrameViews, LeaveOutWhatCannotBeReadWithAWarningThatNamesIt) {
  pictures->torn = {1};
  pictures->torn_masks = {4};
  EXPECT_THAT(names(), ElementsAre("cam0", "cam2"));
  ASSERT_EQ(said.size(), 2u);
  EXPECT_THAT(said[0], AllOf(HasSubstr("picture 1 is torn"), HasSubstr("cam1"), HasSubstr("000007")));
  EXPECT_THAT(said[1], AllOf(HasSubstr("mask 4 is torn"), HasSubstr("cam4"), HasSubstr("000007")));
}

TEST_F(FrameViews, OfPicturesThatTheCaptureDoesNotHaveAreNotMissed) {
  pictures->absent = {0};
  EXPECT_THAT(names(), ElementsAre("cam1", "cam2", "cam4"));
  EXPECT_TRUE(said.empty());
}

TEST_F(FrameViews, FewerThanTwoForTrainingAreAnErrorThatNamesTheFrame) {
  pictures->torn = {0, 1};
  EXPECT_EQ(load().size(), 2u);
  pictures->torn = {0, 1, 2};
  try {
    load();
    FAIL() << "expected an error";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Data);
    EXPECT_THAT(e.what(), AllOf(HasSubstr("000007"), HasSubstr("found 1")));
  }
  pictures->torn = {3};
  EXPECT_TRUE(load(Split::Test).empty()) << "nothing is held out that can be read: nothing to score";
}

TEST_F(FrameViews, StopWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(loadFrameViews(capture, {0}, Split::Train, 1, Progress(stop.get_token())), Cancelled);
}

TEST_F(FrameViews, ScaledDownAreTheShrunkOnes) {
  const std::vector<FrameView> full = load(), half = load(Split::Train, 2);
  ASSERT_EQ(full.size(), half.size());
  for (std::size_t i = 0; i < full.size(); ++i) {
    const FrameView expected = shrunk(full[i], 2);
    EXPECT_EQ(half[i].name, expected.name);
    EXPECT_EQ(half[i].photo.pixels, expected.photo.pixels);
    EXPECT_EQ(half[i].mask.pixels, expected.mask.pixels);
  }
}

TEST_F(FrameViews, ShrunkAreMeansOfBlocksAndKnowTheirCamera) {
  const FrameView full = load()[2], half = shrunk(full, 2);
  EXPECT_EQ(ivec2(half.photo.width, half.photo.height), ivec2(kWidth / 2, kHeight / 2));
  EXPECT_EQ(ivec2(half.camera.width, half.camera.height), ivec2(kWidth / 2, kHeight / 2));
  EXPECT_EQ(half.camera.intrinsics.fx, full.camera.intrinsics.fx / 2);
  EXPECT_EQ(half.photo.encoding, Encoding::Srgb);
  for (int y = 0; y < kHeight / 2; ++y) {
    for (int x = 0; x < kWidth / 2; ++x)
      EXPECT_EQ(half.photo(x, y), u8vec3(2, 20 * x + 5, 40 * y + 10)) << x << " " << y;
  }
  EXPECT_EQ(half.mask(1, 0), 255);
  EXPECT_EQ(half.mask(2, 0), 128) << "half covered, rounded up: still inside";
  EXPECT_EQ(half.mask(3, 0), 0);
  EXPECT_EQ(shrunk(full, 1).photo.pixels, full.photo.pixels);
}

TEST_F(FrameViews, ShrunkByAFactorThatLeavesARestDropTheRest) {
  const FrameView small = shrunk(load()[0], 5);
  EXPECT_EQ(ivec2(small.photo.width, small.photo.height), ivec2(2, 1));
  EXPECT_EQ(small.photo(1, 0), u8vec3(0, 70, 40));  // columns 5 to 9, rows 0 to 4
}

TEST_F(FrameViews, WithoutMasksStayWithoutMasks) {
  pictures->masks = false;
  for (const int downscale : {1, 2}) {
    for (const FrameView& v : load(Split::Train, downscale)) EXPECT_TRUE(v.mask.empty());
  }
}

TEST_F(FrameViews, AFaultOfDiskOrMemoryLeavesNoCameraOut) {
  for (const Error::Kind kind : {Error::Kind::Storage, Error::Kind::OutOfMemory, Error::Kind::Bug}) {
    pictures->fault = [&] { throw Error(kind, "for a moment"); };
    try {
      loadFrameViews(capture, {}, Split::Train, 1, Progress());
      ADD_FAILURE() << "a frame without the camera was given out";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), kind);
    }
  }
  pictures->fault = [] { throw std::bad_alloc(); };
  EXPECT_THROW(loadFrameViews(capture, {}, Split::Train, 1, Progress()), std::bad_alloc);
  EXPECT_TRUE(said.empty());
}

}  // namespace
}  // namespace beam
