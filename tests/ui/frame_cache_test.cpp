// SPDX-License-Identifier: Apache-2.0
#include "ui/frame_cache.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace beam {
namespace {

constexpr std::size_t kGaussians = 100;

std::shared_ptr<const GaussianFrame> frameAt(FrameIndex frame) {
  auto made = std::make_shared<GaussianFrame>();
  made->cloud.position_m.assign(kGaussians, vec3(static_cast<float>(frame.value)));
  return made;
}
const std::uint64_t kFrameBytes = bytesOf(valuesOf(frameAt({})));

std::vector<Digest> stampsOf(int frames) {
  std::vector<Digest> stamps;
  for (int f = 0; f < frames; ++f) stamps.push_back({1, static_cast<std::uint64_t>(f)});
  return stamps;
}

// Ten frames of a source that counts what is read of it.
class Counted final : public GaussianSequence {
 public:
  struct Count {
    std::mutex mutex;
    std::vector<int> read;
    int bad = -1;
  };
  Counted(std::string id, Count& count, std::vector<Digest> stamps)
      : id_(std::move(id)), count_(count), stamps_(std::move(stamps)), labels_(stamps_.size()) {}
  std::string id() const override { return id_; }
  const std::vector<FrameLabel>& frames() const override { return labels_; }
  double rate() const override { return 30; }
  std::optional<Digest> stamp(FrameIndex frame) const override {
    return stamps_[static_cast<std::size_t>(frame.value)];
  }
  FrameContent content(FrameIndex) const override { return {.gaussians = true}; }
  std::shared_ptr<const GaussianFrame> load(FrameIndex frame) const override {
    std::lock_guard lock(count_.mutex);
    count_.read.push_back(frame.value);
    if (frame.value == count_.bad) throw std::runtime_error("torn");
    return frameAt(frame);
  }

 private:
  std::string id_;
  Count& count_;
  std::vector<Digest> stamps_;
  std::vector<FrameLabel> labels_;
};

class Cache : public ::testing::Test {
 protected:
  void make(std::uint64_t budget) {
    cache = std::make_unique<FrameCache>(budget, [this](FrameIndex frame) {
      std::lock_guard lock(count.mutex);
      arrived.push_back(frame.value);
    });
    sequence = snapshot("a", stampsOf(10));
  }
  std::shared_ptr<const GaussianSequence> snapshot(const char* id, std::vector<Digest> stamps) {
    return std::make_shared<const Counted>(id, count, std::move(stamps));
  }
  void want(std::initializer_list<int> frames) {
    std::vector<SequenceFrame> wishes;
    for (const int f : frames) wishes.push_back({sequence, FrameIndex{f}});
    cache->want(std::move(wishes));
    while (!cache->idle()) std::this_thread::yield();
  }
  auto find(int frame) const { return cache->find(*sequence, FrameIndex{frame}); }
  std::vector<int> held() const {
    std::vector<int> frames;
    const std::vector<bool> all = cache->held(*sequence);
    for (int f = 0; f < 10; ++f) {
      if (all[f]) frames.push_back(f);
    }
    return frames;
  }

  Counted::Count count;
  std::vector<int>& read = count.read;
  std::vector<int> arrived;
  std::shared_ptr<const GaussianSequence> sequence;
  std::unique_ptr<FrameCache> cache;
};

TEST_F(Cache, ReadsWishesInTheirOrderAndNothingTwice) {
  make(10 * kFrameBytes);
  want({4, 5, 3});
  EXPECT_EQ(read, (std::vector<int>{4, 5, 3}));
  EXPECT_EQ(arrived, read);
  want({5, 4, 6});
  EXPECT_EQ(read, (std::vector<int>{4, 5, 3, 6}));
  ASSERT_TRUE(find(6));
  EXPECT_EQ(find(6)->values.cloud->position_m[0].x, 6);
  EXPECT_FALSE(find(7));
}

TEST_F(Cache, StaysWithinItsBudgetAndDropsWhatWasUsedLongestAgo) {
  make(3 * kFrameBytes);
  want({0});
  want({1});
  want({2});
  find(0);
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
  sequence = snapshot("a", stamps);
  ASSERT_TRUE(find(4));
  EXPECT_FALSE(find(4)->current);
  EXPECT_EQ(held(), (std::vector<int>{5}));
  want({4, 5});
  EXPECT_TRUE(find(4)->current);
  EXPECT_EQ(read, (std::vector<int>{4, 5, 4}));
}

TEST_F(Cache, SaysWhyAFrameCannotBeReadAndDoesNotTryForever) {
  count.bad = 3;
  make(10 * kFrameBytes);
  want({3, 4});
  ASSERT_TRUE(find(3));
  EXPECT_EQ(find(3)->error, "torn");
  EXPECT_EQ(held(), (std::vector<int>{4}));
}

TEST_F(Cache, ForgetsEverythingWhenAnotherProjectIsOpened) {
  make(10 * kFrameBytes);
  want({1, 2});
  cache->clear();
  EXPECT_TRUE(held().empty());
  EXPECT_EQ(cache->bytes(), 0u);
}

TEST_F(Cache, SnapshotsOfOneSourceShareWhatWasReadAndOtherSourcesDoNot) {
  make(10 * kFrameBytes);
  want({1, 2});
  sequence = snapshot("a", stampsOf(10));
  want({1, 2});
  EXPECT_EQ(read, (std::vector<int>{1, 2}));
  sequence = snapshot("b", stampsOf(10));
  EXPECT_TRUE(held().empty());
  want({1});
  EXPECT_EQ(read, (std::vector<int>{1, 2, 1}));
  EXPECT_EQ(cache->bytes(), 3 * kFrameBytes);
}

TEST_F(Cache, OneBudgetHoldsForAllSources) {
  make(3 * kFrameBytes);
  want({1, 2});
  const auto first = sequence;
  sequence = snapshot("b", stampsOf(10));
  want({5});
  want({6});
  EXPECT_EQ(cache->bytes(), 3 * kFrameBytes);
  EXPECT_EQ(held(), (std::vector<int>{5, 6}));
  sequence = first;
  EXPECT_EQ(held(), (std::vector<int>{2}));
}

}  // namespace
}  // namespace beam
