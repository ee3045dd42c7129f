// SPDX-License-Identifier: Apache-2.0
#include "ui/frame_cache.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <stdexcept>

namespace beam {
namespace {

constexpr std::size_t kGaussians = 100;

FrameValues valuesOfFrame(FrameIndex frame) {
  auto cloud = std::make_shared<GaussianCloud>();
  cloud->position_m.assign(kGaussians, vec3(static_cast<float>(frame.value)));
  return {cloud, nullptr, nullptr};
}
const std::uint64_t kFrameBytes = bytesOf(valuesOfFrame({}));

std::vector<FrameIndex> framesOf(std::initializer_list<int> values) {
  std::vector<FrameIndex> frames;
  for (const int v : values) frames.push_back(FrameIndex{v});
  return frames;
}

std::vector<Digest> stampsOf(int frames) {
  std::vector<Digest> stamps;
  for (int f = 0; f < frames; ++f) stamps.push_back({1, static_cast<std::uint64_t>(f)});
  return stamps;
}

// A cache over ten frames that counts what it reads.
class Cache : public ::testing::Test {
 protected:
  void make(std::uint64_t budget) {
    cache = std::make_unique<FrameCache>(budget, [this](FrameIndex frame) {
      std::lock_guard lock(mutex);
      arrived.push_back(frame.value);
    });
    cache->setSource(loader(), stampsOf(10));
  }
  FrameCache::Load loader() {
    return [this](FrameIndex frame) {
      std::lock_guard lock(mutex);
      read.push_back(frame.value);
      if (frame.value == bad) throw std::runtime_error("torn");
      return valuesOfFrame(frame);
    };
  }
  void want(std::initializer_list<int> frames) {
    cache->want(framesOf(frames));
    while (!cache->idle()) std::this_thread::yield();
  }
  std::vector<int> held() const {
    std::vector<int> frames;
    const std::vector<bool> all = cache->held(10);
    for (int f = 0; f < 10; ++f) {
      if (all[f]) frames.push_back(f);
    }
    return frames;
  }

  std::mutex mutex;
  std::vector<int> read, arrived;
  int bad = -1;
  std::unique_ptr<FrameCache> cache;
};

TEST_F(Cache, ReadsWishesInTheirOrderAndNothingTwice) {
  make(10 * kFrameBytes);
  want({4, 5, 3});
  EXPECT_EQ(read, (std::vector<int>{4, 5, 3}));
  EXPECT_EQ(arrived, read);
  want({5, 4, 6});
  EXPECT_EQ(read, (std::vector<int>{4, 5, 3, 6}));
  ASSERT_TRUE(cache->find(FrameIndex{6}));
  EXPECT_EQ(cache->find(FrameIndex{6})->values.cloud->position_m[0].x, 6);
  EXPECT_FALSE(cache->find(FrameIndex{7}));
}

TEST_F(Cache, StaysWithinItsBudgetAndDropsWhatWasUsedLongestAgo) {
  make(3 * kFrameBytes);
  want({0});
  want({1});
  want({2});
  cache->find(FrameIndex{0});
  want({3});
  EXPECT_EQ(held(), (std::vector<int>{0, 2, 3}));
  EXPECT_LE(cache->bytes(), cache->budget());
}

TEST_F(Cache, AWishForLaterDoesNotPushOutAMoreUrgentOne) {
  make(3 * kFrameBytes);
  want({0, 1, 2, 3, 4, 5});
  EXPECT_EQ(held(), (std::vector<int>{0, 1, 2}));
  EXPECT_LE(cache->bytes(), cache->budget());
  want({1, 2, 3, 4});
  EXPECT_EQ(held(), (std::vector<int>{1, 2, 3}));
  want({1, 2, 3, 4});
  EXPECT_EQ(read, (std::vector<int>{0, 1, 2, 3})) << "what does not fit is not read in vain";
}

TEST_F(Cache, TheMostUrgentFrameIsReadHoweverLargeItIs) {
  make(kFrameBytes / 2);
  want({7, 8});
  EXPECT_EQ(held(), (std::vector<int>{7}));
  want({2});
  EXPECT_EQ(held(), (std::vector<int>{2}));
}

TEST_F(Cache, ANewerResultIsReadAgainAndTheOldOneStaysUntilThen) {
  make(10 * kFrameBytes);
  want({4, 5});
  std::vector<Digest> stamps = stampsOf(10);
  stamps[4] = {2, 4};
  cache->want({});
  cache->setSource(loader(), stamps);
  ASSERT_TRUE(cache->find(FrameIndex{4}));
  EXPECT_FALSE(cache->find(FrameIndex{4})->current);
  EXPECT_EQ(held(), (std::vector<int>{5}));
  want({4, 5});
  EXPECT_TRUE(cache->find(FrameIndex{4})->current);
  EXPECT_EQ(read, (std::vector<int>{4, 5, 4}));
}

TEST_F(Cache, SaysWhyAFrameCannotBeReadAndDoesNotTryForever) {
  bad = 3;
  make(10 * kFrameBytes);
  want({3, 4});
  ASSERT_TRUE(cache->find(FrameIndex{3}));
  EXPECT_EQ(cache->find(FrameIndex{3})->error, "torn");
  EXPECT_EQ(held(), (std::vector<int>{4}));
}

TEST_F(Cache, ForgetsEverythingWhenAnotherProjectIsOpened) {
  make(10 * kFrameBytes);
  want({1, 2});
  cache->clear();
  EXPECT_TRUE(held().empty());
  EXPECT_EQ(cache->bytes(), 0u);
}

}  // namespace
}  // namespace beam
