// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/frame_store.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <map>
#include <new>
#include <thread>

#include "core/base/log.h"
#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr int kViews = 4, kFrames = 12, kSide = 8;
constexpr int kSteady = 6;  // frames from here on are for tests that replace pictures
constexpr std::size_t kFrameBytes = std::size_t{3} * kViews * kSide * kSide;

// Pictures are files of one number, the grey value; negative: cannot be read. Counts what is decoded.
class CountedFrames final : public FrameSource {
 public:
  explicit CountedFrames(fs::path folder) : folder_(std::move(folder)) {
    for (int v = 0; v < kViews; ++v) {
      for (int f = 0; f < kFrames; ++f) write(v, f, 20 * v + f);
    }
  }
  // A new file, as tools that export pictures put it.
  void write(int view, int frame, int value) const {
    std::ofstream(folder_ / "new") << value;
    fs::rename(folder_ / "new", fileOf({view}, {frame}));
  }
  bool has(ViewIndex, FrameIndex) const override { return true; }
  Image<u8vec3> photo(ViewIndex view, FrameIndex frame) const override {
    {
      std::unique_lock lock(mutex_);
      ++decoded_[frame.value];
      changed_.notify_all();
      changed_.wait(lock, [&] { return closed_ != frame.value; });
      if (no_memory_for_ == frame.value) throw std::bad_alloc();
      if (no_disk_for_ == frame.value) throw Error(Error::Kind::Storage, "the disk does not answer");
    }
    const int value = std::stoi(readTextFile(fileOf(view, frame)));
    if (value < 0)
      throw Error(Error::Kind::Data, fmt::format("cannot read {}", fileOf(view, frame).string()));
    return Image<u8vec3>(kSide, kSide, u8vec3(static_cast<std::uint8_t>(value)));
  }
  Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return {}; }
  std::vector<std::string> files(ViewIndex view, FrameIndex frame) const override {
    return {fileOf(view, frame).string()};
  }

  std::map<int, int> takeDecoded() {
    std::lock_guard lock(mutex_);
    return std::exchange(decoded_, {});
  }
  void awaitDecoded(int frame, int count) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, 60s, [&] { return decoded_[frame] >= count; }));
  }
  // Lets nobody finish a picture of this frame; -1: opens all.
  void close(int frame) {
    std::lock_guard lock(mutex_);
    closed_ = frame;
    changed_.notify_all();
  }
  void refuseMemory(int frame) {
    std::lock_guard lock(mutex_);
    no_memory_for_ = frame;
  }
  void refuseDisk(int frame) {
    std::lock_guard lock(mutex_);
    no_disk_for_ = frame;
  }

 private:
  fs::path fileOf(ViewIndex view, FrameIndex frame) const {
    return folder_ / (fmt::format("{}-{}", view.value, frame.value));
  }
  fs::path folder_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  mutable std::map<int, int> decoded_;  // pictures by frame
  int closed_ = -1, no_memory_for_ = -1, no_disk_for_ = -1;
};

class FrameStoreTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (source_) return;  // another fixture made them
    folder_ = std::make_unique<TempDir>();
    source_ = std::make_shared<CountedFrames>(folder_->path());
    std::this_thread::sleep_for(2100ms);  // younger files are not trusted to stay
  }
  FrameStoreTest() {
    for (int v = 0; v < kViews; ++v)
      capture_.views.push_back({fmt::format("cam{}", v), {{9, 9, 4, 4}, kSide, kSide, {}}, Split::Train});
    for (int f = 0; f < kFrames; ++f) capture_.frames.push_back(fmt::format("f{}", f));
    capture_.source = source_;
    source_->takeDecoded();
    sink_ = addLogSink([this](const LogRecord& r) {
      if (r.level == LogLevel::Warning) warnings_.push_back(r.text);
    });
  }
  ~FrameStoreTest() override {
    removeLogSink(sink_);
    source_->close(-1);
    source_->refuseMemory(-1);
    source_->refuseDisk(-1);
  }

  LentViews lend(FrameStore& store, int frame, int downscale = 1) const {
    return store.lend(
        {frame}, downscale, [](const std::string&) { return true; }, progress_);
  }
  static std::vector<int> greys(const LentViews& lent) {
    std::vector<int> values;
    for (const FrameView& v : lent.all()) values.push_back(v.photo.pixels[0].x);
    return values;
  }
  std::vector<int> greysOf(FrameStore& store, int frame) const { return greys(lend(store, frame)); }

  static inline std::unique_ptr<TempDir> folder_;
  static inline std::shared_ptr<CountedFrames> source_;
  CaptureSet capture_;
  std::vector<std::string> warnings_;
  Progress progress_;
  int sink_ = 0;
};

using Counts = std::map<int, int>;

TEST_F(FrameStoreTest, ADiskThatFailsForAMomentCostsNoCamera) {
  FrameStore store(capture_);
  source_->refuseDisk(2);
  EXPECT_THROW(lend(store, 2), Error);
  store.expect(FrameIndex{2});
  EXPECT_THAT(greysOf(store, 1), ElementsAre(1, 21, 41, 61));  // decodes frame 2 ahead, in vain
  EXPECT_THROW(lend(store, 2), Error);
  source_->refuseDisk(-1);
  EXPECT_THAT(greysOf(store, 2), ElementsAre(2, 22, 42, 62));
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(FrameStoreTest, LendsWhatLoadingGivesAndDecodesItOnceForAllSteps) {
  const std::vector<FrameView> loaded = loadFrameViews(capture_, {3}, Split::Train, 2, progress_);
  source_->takeDecoded();
  FrameStore store(capture_);
  for (int step = 0; step < 3; ++step) {
    const LentViews lent = lend(store, 3, 2);
    ASSERT_EQ(lent.all().size(), loaded.size());
    for (std::size_t i = 0; i < loaded.size(); ++i) {
      EXPECT_EQ(lent.all()[i].name, loaded[i].name);
      EXPECT_EQ(lent.all()[i].photo.pixels, loaded[i].photo.pixels);
      EXPECT_EQ(lent.all()[i].camera.width, loaded[i].camera.width);
    }
  }
  EXPECT_EQ(source_->takeDecoded(), (Counts{{3, kViews}}));
  lend(store, 3, 1);
  EXPECT_EQ(source_->takeDecoded(), (Counts{{3, kViews}})) << "another resolution";
}

TEST_F(FrameStoreTest, LendsOnlyTheWantedViewsAndKeepsTheOthers) {
  FrameStore store(capture_);
  const auto lendWhere = [&](bool second) {
    return greys(store.lend(
        {1}, 1, [&](const std::string& n) { return (n == "cam1") == second; }, progress_));
  };
  EXPECT_THAT(lendWhere(false), ElementsAre(1, 41, 61));
  EXPECT_THAT(lendWhere(true), ElementsAre(21));
  EXPECT_THAT(greysOf(store, 1), ElementsAre(1, 21, 41, 61));
  EXPECT_EQ(source_->takeDecoded(), (Counts{{1, kViews}}));
}

TEST_F(FrameStoreTest, WhoAsksForLentViewsGetsHisOwn) {
  FrameStore store(capture_);
  const LentViews first = lend(store, 1);
  EXPECT_THAT(greysOf(store, 1), ElementsAre(1, 21, 41, 61));
  EXPECT_THAT(greys(first), ElementsAre(1, 21, 41, 61));
}

TEST_F(FrameStoreTest, DecodesTheExpectedFrameAheadAndNoFurther) {
  FrameStore store(capture_);
  store.expect(FrameIndex{1});
  lend(store, 0);
  source_->awaitDecoded(1, kViews);
  lend(store, 0);
  EXPECT_EQ(source_->takeDecoded(), (Counts{{0, kViews}, {1, kViews}}));
  store.expect({});
  EXPECT_THAT(greysOf(store, 1), ElementsAre(1, 21, 41, 61));
  EXPECT_LE(source_->takeDecoded()[1], 1) << "at most the picture that was not handed over yet";
}

TEST_F(FrameStoreTest, HoldsTwoFramesHoweverManyThereAre) {
  FrameStore store(capture_);
  for (int f = 0; f < kSteady; ++f) {
    store.expect(f + 1 < kSteady ? std::optional(FrameIndex{f + 1}) : std::nullopt);
    for (int step = 0; step < 3; ++step) {
      const LentViews lent = lend(store, f);
      EXPECT_LE(store.bytes(), 2 * kFrameBytes);
    }
    if (f + 1 < kSteady) source_->awaitDecoded(f + 1, kViews);
  }
  EXPECT_EQ(store.bytes(), kFrameBytes);
  for (const auto& [frame, decoded] : source_->takeDecoded()) EXPECT_LE(decoded, kViews + 1) << frame;
}

TEST_F(FrameStoreTest, AFrameThatNobodyExpectsTakesThePlaceOfTheNext) {
  FrameStore store(capture_);
  store.expect(FrameIndex{1});
  lend(store, 0);
  store.expect({});
  EXPECT_THAT(greysOf(store, 5), ElementsAre(5, 25, 45, 65));
  EXPECT_EQ(store.bytes(), kFrameBytes);
}

TEST_F(FrameStoreTest, AReplacedPictureIsDecodedAnewAloneAlsoWhenItWasDecodedAhead) {
  FrameStore store(capture_);
  store.expect(FrameIndex{7});
  lend(store, 6);
  source_->awaitDecoded(7, kViews);
  source_->write(1, 6, 200);
  source_->write(2, 7, 201);
  source_->takeDecoded();
  EXPECT_THAT(greysOf(store, 6), ElementsAre(6, 200, 46, 66));
  EXPECT_EQ(source_->takeDecoded()[6], 1);
  EXPECT_THAT(greysOf(store, 7), ElementsAre(7, 27, 201, 67));
  source_->write(1, 6, 26);
  source_->write(2, 7, 47);
}

TEST_F(FrameStoreTest, ADamagedPictureIsToldInEveryStepThatGetsTheFrameAndNoOther) {
  source_->write(1, 9, -1);
  loadFrameViews(capture_, {9}, Split::Train, 1, progress_);
  const std::vector<std::string> told = std::exchange(warnings_, {});
  ASSERT_EQ(told.size(), 1u);
  FrameStore store(capture_);
  store.expect(FrameIndex{9});
  lend(store, 8);
  source_->awaitDecoded(9, kViews);
  lend(store, 8);
  EXPECT_TRUE(warnings_.empty());
  EXPECT_THAT(greysOf(store, 9), ElementsAre(9, 49, 69));
  EXPECT_EQ(std::exchange(warnings_, {}), told);
  lend(store, 9);
  EXPECT_EQ(std::exchange(warnings_, {}), told);
  source_->write(0, 9, -1);
  source_->write(2, 9, -1);
  EXPECT_THROW(lend(store, 9), Error);
  for (const int v : {0, 1, 2}) source_->write(v, 9, 20 * v + 9);
}

TEST_F(FrameStoreTest, WithoutMemoryForTheNextFrameItIsDecodedInItsTurn) {
  source_->refuseMemory(1);
  FrameStore store(capture_);
  store.expect(FrameIndex{1});
  EXPECT_THAT(greysOf(store, 0), ElementsAre(0, 20, 40, 60));
  source_->awaitDecoded(1, 1);
  EXPECT_THAT(greysOf(store, 0), ElementsAre(0, 20, 40, 60));
  EXPECT_THROW(lend(store, 1), std::bad_alloc);
  source_->refuseMemory(-1);
  EXPECT_THAT(greysOf(store, 1), ElementsAre(1, 21, 41, 61));
}

TEST_F(FrameStoreTest, HavingGivenUpItKeepsNothing) {
  FrameStore store(capture_);
  EXPECT_FALSE(store.giveUp());
  FrameStore other(capture_);
  other.expect(FrameIndex{1});
  const LentViews before = lend(other, 0);
  EXPECT_TRUE(other.giveUp());
  EXPECT_FALSE(other.giveUp());
  source_->takeDecoded();
  for (int step = 0; step < 2; ++step) EXPECT_THAT(greysOf(other, 0), ElementsAre(0, 20, 40, 60));
  EXPECT_EQ(source_->takeDecoded(), (Counts{{0, 2 * kViews}}));
  EXPECT_EQ(other.bytes(), 0u);
}

TEST_F(FrameStoreTest, StopsWhileItWaitsForAPictureThatIsDecodedAhead) {
  FrameStore store(capture_);
  store.expect(FrameIndex{1});
  source_->close(1);
  lend(store, 0);
  source_->awaitDecoded(1, 1);
  std::stop_source stop;
  const Progress stoppable(stop.get_token());
  std::jthread user([&] { stop.request_stop(); });
  const auto all = [](const std::string&) { return true; };
  EXPECT_THROW(store.lend({1}, 1, all, stoppable), Cancelled);
  EXPECT_THROW(store.lend({2}, 1, all, stoppable), Cancelled);
  source_->close(-1);
}

// A run over the same pictures, of which two steps of each frame ask for all views.
class RunWithPictures : public FrameStoreTest {
 protected:
  RunWithPictures() {
    house_.frame_names = {"f0", "f1", "f2"};
    house_.setup->open_capture = [open = house_.setup->open_capture](const auto& folder,
                                                                     const auto& options) {
      ImportedCapture imported = open(folder, options);
      imported.set.source = source_;
      return imported;
    };
    house_.hooks.at_step = [this](const StepId& step, StepContext& c) {
      const bool reads = step == "surface.seed"_step || step == "surface.fit"_step;
      EXPECT_EQ(c.frames != nullptr, reads) << step;
      if (reads) {
        EXPECT_EQ(greysOf(*c.frames, c.frame.value).size(), 3u);
      }
      if (at_step_) at_step_(step, c.frame.value);
    };
  }
  // By frame, without the picture that surface.seed reads itself.
  static Counts decoded() {
    Counts counts = source_->takeDecoded();
    for (auto& [frame, count] : counts) --count;
    return counts;
  }

  FakeHouse house_;
  std::function<void(const StepId& step, int frame)> at_step_;
};

TEST_F(RunWithPictures, DecodesEachFrameOnceAndAheadOfItsTurn) {
  at_step_ = [](const StepId& step, int frame) {
    if (step == "surface.refine"_step && frame < 2) source_->awaitDecoded(frame + 1, 3);
  };
  EXPECT_EQ(house_.finish(house_.newProject()).outcome, JobOutcome::Done);
  const Counts counts = decoded();
  EXPECT_EQ(counts.at(0), 3);
  for (const int frame : {1, 2}) EXPECT_LE(counts.at(frame), 3 + 1);
}

TEST_F(RunWithPictures, DecodesNothingOfAFrameThatIsDone) {
  house_.finish(house_.newProject(), {{FrameIndex{1}}});
  decoded();
  EXPECT_EQ(house_.finish(house_.open(), {{FrameIndex{0}, FrameIndex{1}}}).outcome, JobOutcome::Done);
  EXPECT_EQ(decoded(), (Counts{{0, 3}}));
}

TEST_F(RunWithPictures, AStepThatFindsNoMemoryIsTriedAgainWithoutKeptPictures) {
  int tries = 0;
  at_step_ = [&](const StepId& step, int frame) {
    if (step == "surface.fit"_step && frame == 1 && ++tries == 1) throw std::bad_alloc();
  };
  const JobFinished finished = house_.finish(house_.newProject());
  EXPECT_EQ(finished.outcome, JobOutcome::Done);
  EXPECT_EQ(finished.computed, 2 + 3 * 4);
  EXPECT_EQ(tries, 2);
}

}  // namespace
}  // namespace beam::testing
