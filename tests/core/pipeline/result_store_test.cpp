// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/result_store.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/base/error.h"
#include "tests/support/few_descriptors.h"
#include "tests/support/step_literal.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class Store : public ::testing::Test {
 protected:
  TempDir folder_;
  ResultStore store_{folder_.path()};
  Digest key_ = digestOf("a key");

  void publish(const std::string& text = "hello") {
    store_.publish(key_, {}, [&](const fs::path& folder, ResultRecord& record) {
      fs::create_directory(folder / "maps");
      std::ofstream(folder / "a.txt") << text;
      std::ofstream(folder / "maps" / "b.txt") << text << text;
      record.scores["loss"] = 0.25;
    });
  }
  fs::path file(const char* name) const { return store_.folderOf(key_) / name; }
  int quarantined() const {
    return fs::exists(folder_.path() / "quarantine")
               ? static_cast<int>(std::distance(fs::directory_iterator(folder_.path() / "quarantine"), {}))
               : 0;
  }
  // As another process sees it: nothing remembered.
  bool freshlyVerified() const { return ResultStore(folder_.path()).verified(key_).has_value(); }
};

TEST_F(Store, WhatIsPublishedIsThere) {
  EXPECT_FALSE(store_.has(key_));
  publish();
  EXPECT_TRUE(store_.has(key_));
  EXPECT_EQ(store_.verified(key_), store_.folderOf(key_));
  const auto record = store_.record(key_);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->files.size(), 2u);
  EXPECT_EQ(record->files.at("maps/b.txt").bytes, 10u);
  EXPECT_EQ(record->files.at("a.txt").digest, digestOf("hello"));
  EXPECT_EQ(record->scores.at("loss"), 0.25);
}

TEST_F(Store, ABuildThatThrowsLeavesNothing) {
  EXPECT_THROW(store_.publish(key_, {},
                              [](const fs::path& folder, ResultRecord&) {
                                std::ofstream(folder / "half.txt") << "half";
                                throw Error(Error::Kind::Data, "no");
                              }),
               Error);
  EXPECT_FALSE(store_.has(key_));
  EXPECT_TRUE(fs::is_empty(folder_.path() / "results"));
}

TEST_F(Store, EveryFlippedByteIsFound) {
  for (const char* name : {"a.txt", "maps/b.txt"}) {
    for (int at = 0; at < 5; ++at) {
      publish();
      std::fstream stream(file(name), std::ios::in | std::ios::out | std::ios::binary);
      stream.seekp(at);
      stream.put('X');
      stream.close();
      EXPECT_FALSE(freshlyVerified()) << name << " byte " << at;
      EXPECT_FALSE(store_.has(key_));
    }
  }
  EXPECT_EQ(quarantined(), 10);
}

TEST_F(Store, AMissingOrShortFileIsFoundWithoutReading) {
  publish();
  fs::resize_file(file("a.txt"), 3);
  EXPECT_FALSE(store_.has(key_));
  EXPECT_FALSE(store_.verified(key_));
  publish();
  fs::remove(file("maps/b.txt"));
  EXPECT_FALSE(store_.has(key_));
  EXPECT_FALSE(store_.verified(key_));
  EXPECT_EQ(quarantined(), 2);
}

TEST_F(Store, ADiskThatFailsForAMomentIsNoDamage) {
  publish();
  {
    const FewDescriptors few;
    EXPECT_THROW(store_.record(key_), Error);
    EXPECT_THROW(store_.verified(key_), Error);
  }
  EXPECT_EQ(quarantined(), 0);
  EXPECT_TRUE(freshlyVerified());
}

TEST_F(Store, AResultWithoutItsRecordIsNone) {
  publish();
  fs::remove(file("result.json"));
  EXPECT_FALSE(store_.has(key_));
  EXPECT_FALSE(freshlyVerified());
  publish();
  std::ofstream(file("result.json")) << "{\"key\": 3";
  EXPECT_FALSE(freshlyVerified());
  publish();
  EXPECT_TRUE(freshlyVerified());
}

TEST_F(Store, ARecordUnderAnotherKeyIsNone) {
  publish();
  const Digest other = digestOf("another key");
  fs::rename(store_.folderOf(key_), store_.folderOf(other));
  EXPECT_FALSE(store_.verified(other));
}

TEST_F(Store, AWholeResultIsNeverOverwritten) {
  publish("first");
  publish("second");
  EXPECT_TRUE(freshlyVerified());
  EXPECT_EQ(store_.record(key_)->files.at("a.txt").digest, digestOf("first"));
}

TEST_F(Store, WhatTheDiskRefusesABuilderIsAnErrorOfTheDisk) {
  try {
    store_.publish(key_, {}, [](const fs::path& folder, ResultRecord&) {
      std::ofstream(folder / "a") << "a file";
      fs::create_directory(folder / "a" / "b");
    });
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Storage);
  }
}

TEST_F(Store, ADamagedResultGivesWayToANewOne) {
  publish("first");
  std::ofstream(file("a.txt")) << "fi7st";
  publish("second");
  EXPECT_TRUE(freshlyVerified());
  EXPECT_EQ(store_.record(key_)->files.at("a.txt").digest, digestOf("second"));
}

TEST_F(Store, HalfBuiltFoldersOfTheDeadAreRemovedThoseOfTheLivingStay) {
  const fs::path results = folder_.path() / "results";
  const Digest live = digestOf("live"), dead = digestOf("dead");
  fs::create_directories(results / ("." + live.hex() + ".123.tmp"));
  fs::create_directories(results / ("." + dead.hex() + ".123.tmp"));
  const fs::path foreign = results / ("." + std::string(40, 'x') + ".tmp");
  fs::create_directories(foreign);
  const auto lease = store_.tryLease(live);
  ASSERT_TRUE(lease);
  Progress progress;
  store_.removeStale(progress);
  EXPECT_TRUE(fs::exists(foreign)) << "not ours";
  EXPECT_TRUE(fs::exists(results / ("." + live.hex() + ".123.tmp")));
  EXPECT_FALSE(fs::exists(results / ("." + dead.hex() + ".123.tmp")));
}

TEST_F(Store, OneLeaseAKey) {
  {
    const auto mine = store_.tryLease(key_);
    ASSERT_TRUE(mine);
    EXPECT_TRUE(store_.isLeased(key_));
    EXPECT_FALSE(store_.tryLease(key_));
    EXPECT_TRUE(store_.tryLease(digestOf("other")));
  }
  EXPECT_FALSE(store_.isLeased(key_));
  EXPECT_TRUE(store_.tryLease(key_));
}

TEST_F(Store, RecordsSurviveTheTripThroughJson) {
  ResultRecord r;
  r.key = key_;
  r.ingredients = {"surface.fit"_step,
                   3,
                   {{"a.b", "0.1"}},
                   {{"pictures", digestOf("p")}},
                   {{"s.t"_step, digestOf("u")}},
                   {{"s.v"_step, digestOf("v")}},
                   true};
  r.files["x.ply"] = {12, digestOf("x")};
  r.frame = "000001";
  r.warnings = {"a \"quoted\" warning\n"};
  r.seconds = 0.1;
  const ResultRecord back = parseResultRecord(toJson(r));
  EXPECT_EQ(toJson(back), toJson(r));
  EXPECT_EQ(keyOf(back.ingredients), keyOf(r.ingredients));
  EXPECT_EQ(back.ingredients.previous, r.ingredients.previous);
}

TEST_F(Store, ARecordSaysBesideItsKeyWhatItIs) {
  ResultRecord r;
  r.key = key_;
  r.ingredients.step = "surface.refine"_step;
  r.frame = "000002";
  EXPECT_EQ(aboutText(r), "surface.refine of frame 000002; every setting has its default");
  r.ingredients.parameters = {{"surface.cap", "20"}, {"surface.iterations", "500"}};
  r.ingredients.later = true;
  const std::string about =
      "surface.refine of frame 000002, built on the frame before; differs from the defaults in "
      "surface.cap = 20, surface.iterations = 500";
  EXPECT_EQ(aboutText(r), about);
  EXPECT_THAT(toJson(r),
              HasSubstr(fmt::format("\"key\": \"{}\",\n  \"about\": \"{}\",\n", key_.hex(), about)));
  r.frame.clear();
  EXPECT_THAT(aboutText(r), StartsWith("surface.refine of the whole project"));
}

TEST_F(Store, RecordsWithoutTheNoteOrWithAnotherAreReadAlike) {
  ResultRecord r;
  r.key = key_;
  r.ingredients.step = "surface.fit"_step;
  const std::string json = toJson(r), note = fmt::format("  \"about\": \"{}\",\n", aboutText(r));
  for (const char* other : {"", "  \"about\": 3,\n"}) {
    std::string changed = json;
    changed.replace(json.find(note), note.size(), other);
    EXPECT_EQ(toJson(parseResultRecord(changed)), json);
  }
}

TEST_F(Store, ADiscardedResultIsNoneAndItsFolderIsDeletedWithTheHalfBuilt) {
  publish();
  {
    const auto lease = store_.tryLease(key_);
    store_.discard(key_);
    EXPECT_FALSE(store_.has(key_));
    EXPECT_FALSE(store_.verified(key_));
    EXPECT_EQ(quarantined(), 0);
    EXPECT_THAT(store_.stale(), IsEmpty()) << "somebody is at it";
  }
  ASSERT_EQ(store_.stale().size(), 1u);
  EXPECT_TRUE(fs::exists(store_.stale()[0] / "maps" / "b.txt"));
  Progress progress;
  store_.removeStale(progress);
  EXPECT_TRUE(fs::is_empty(folder_.path() / "results"));
  publish("again");
  EXPECT_TRUE(freshlyVerified());
}

TEST_F(Store, AStopLeavesTheRestOfTheHalfBuiltToTheNextTime) {
  publish();
  store_.discard(key_);
  std::stop_source stop;
  stop.request_stop();
  Progress stopped(stop.get_token());
  EXPECT_THROW(store_.removeStale(stopped), Cancelled);
  EXPECT_EQ(store_.stale().size(), 1u);
  Progress progress;
  store_.removeStale(progress);
  EXPECT_TRUE(fs::is_empty(folder_.path() / "results"));
}

}  // namespace
}  // namespace beam::testing
