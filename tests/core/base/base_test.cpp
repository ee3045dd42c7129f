// SPDX-License-Identifier: Apache-2.0
// Laws of the ground floor: fields, progress, parallel work, random numbers, digests.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>

#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/field_text.h"
#include "core/base/fields_json.h"
#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/base/progress.h"
#include "core/base/rng.h"
#include "core/base/word_list.h"

namespace beam {
namespace {

struct Options {
  int steps = 10;
  double weight = 0.5;
  bool on = false;
  std::string kind = "a";
};
void describe(Fields& f, Options& o) {
  f.field({.name = "steps", .label = "Steps", .help = "", .min = 1, .max = 100}, o.steps);
  f.group("inner",
          [&] { f.field({.name = "weight", .label = "Weight", .help = "", .min = 0, .max = 1}, o.weight); });
  f.field({.name = "on", .label = "On", .help = ""}, o.on);
  f.field({.name = "kind", .label = "Kind", .help = "", .choices = {"a", "b"}}, o.kind);
}

TEST(WordList, Utf8IsToldFromOtherBytes) {
  for (const char* whole : {"", "plain", "caf\u00e9", "\u20ac", "\U0001f600", "\uffff", "\U0010ffff"})
    EXPECT_TRUE(isUtf8(whole)) << whole;
  for (const char* other : {"caf\xe9", "\xc3", "\x80", "\xc0\xaf", "\xe0\x80\x80", "\xed\xa0\x80",
                            "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80", "\xe2\x82", "\xe2\x82g"})
    EXPECT_FALSE(isUtf8(other)) << other;
}

bool set(Options& o, const std::string& name, const std::string& text) {
  FieldSetter setter(name, parseFieldValue(text));
  describe(setter, o);
  return setter.found;
}

TEST(Fields, AreListedInOrderWithTheirGroups) {
  std::vector<std::string> names;
  for (const Field& f : fieldsOf(Options{})) names.push_back(f.info.name);
  EXPECT_EQ(names, (std::vector<std::string>{"steps", "inner.weight", "on", "kind"}));
}

TEST(Fields, TakeValuesByNameAndKeepThemInRange) {
  Options o;
  EXPECT_TRUE(set(o, "inner.weight", "0.25"));
  EXPECT_TRUE(set(o, "steps", "7"));
  EXPECT_TRUE(set(o, "on", "true"));
  EXPECT_TRUE(set(o, "kind", "b"));
  EXPECT_EQ(o.weight, 0.25);
  EXPECT_EQ(o.steps, 7);
  EXPECT_EQ(o.kind, "b");
  EXPECT_FALSE(set(o, "weight", "1"));
  for (const auto& [name, text] :
       {std::pair{"steps", "0"}, {"steps", "1.5"}, {"inner.weight", "2"}, {"on", "1"}, {"kind", "c"}}) {
    EXPECT_THROW(set(o, name, text), Error) << name << " " << text;
  }
  EXPECT_EQ(o.steps, 7);
}

TEST(Fields, SayInWordsWhatTheyTake) {
  EXPECT_EQ(rangeText({.name = "n", .label = "", .help = "", .min = 2, .max = 1e6}), "2 to 1,000,000");
  EXPECT_EQ(rangeText({.name = "n", .label = "", .help = "", .min = 5e-4, .max = 0.1, .unit = "m"}),
            "0.0005 to 0.1 m");
  EXPECT_EQ(rangeText({.name = "n", .label = "", .help = "", .min = 1}), "at least 1");
  EXPECT_EQ(rangeText({.name = "n", .label = "", .help = "", .max = -1234.5}), "at most -1,234.5");
  EXPECT_EQ(rangeText({.name = "n", .label = "", .help = ""}), "");
  EXPECT_EQ(expectedText({.name = "n", .label = "", .help = "", .min = 2, .max = 1e6}, 7),
            "a whole number from 2 to 1,000,000");
  EXPECT_EQ(expectedText({.name = "n", .label = "", .help = "", .min = 1}, 0.5), "a number of at least 1");
  EXPECT_EQ(expectedText({.name = "n", .label = "", .help = "", .choices = {"a", "b"}}, std::string("a")),
            "one of a, b");
  Options o;
  try {
    set(o, "steps", "1000");
    FAIL() << "1000 steps were taken";
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "steps expects a whole number from 1 to 100, found 1000");
  }
}

TEST(Fields, TheNearestNameIsFoundForATypingError) {
  EXPECT_EQ(nearestName("itertions", {"cap", "iterations", "seed"}), "iterations");
}

TEST(Fields, ANameIsSimilarUpToAThirdOfItsLettersAndLettersThatChangedPlacesCountOnce) {
  const std::vector<std::string> known = {"run", "render", "report"};
  EXPECT_EQ(similarName("rnu", known), "run");
  EXPECT_EQ(similarName("ru", known), "run");
  EXPECT_EQ(similarName("rendre", known), "render");
  EXPECT_EQ(similarName("rapprt", known), "report");
  EXPECT_EQ(similarName("rx", known), std::nullopt);
  EXPECT_EQ(similarName("frobnicate", known), std::nullopt);
  EXPECT_EQ(similarName("run", {}), std::nullopt);
}

TEST(Fields, AnUnknownNameIsToldWithASimilarOneOrWhereToLook) {
  EXPECT_EQ(noSuchName("setting", "itertions", {"cap", "iterations"}, "beam stages lists them"),
            "there is no setting \"itertions\"; did you mean \"iterations\"?");
  EXPECT_EQ(noSuchName("setting", "colour", {"cap", "iterations"}, "beam stages lists them"),
            "there is no setting \"colour\"; beam stages lists them");
}

TEST(Fields, KnownNamesAreAllOfFewAndTheNearestOfMany) {
  EXPECT_EQ(knownNames("cameras", "door", {"cam00", "cam01"}), "the cameras are cam00, cam01");
  std::vector<std::string> many;
  for (int i = 0; i < 40; ++i) many.push_back("cam" + std::to_string(10 + i));
  many.emplace_back("door1");
  const std::string text = knownNames("cameras", "door", many);
  EXPECT_THAT(text, ::testing::StartsWith("the cameras nearest to it are door1, "));
  EXPECT_THAT(text, ::testing::EndsWith("(of 41)"));
}

TEST(WordList, AShortListSaysHowManyMoreThereAre) {
  EXPECT_EQ(shortList({"a", "b"}, 2), "a, b");
  EXPECT_EQ(shortList({"a", "b", "c", "d"}, 2), "a, b and 2 more");
}

TEST(Fields, JsonHoldsEveryValue) {
  const std::string json = fieldsToJson(fieldsOf(Options{}));
  EXPECT_THAT(json, ::testing::HasSubstr("\"inner.weight\": 0.5"));
  EXPECT_THROW(parseFieldValue("[1]"), Error);
}

TEST(Fields, ValuesAreTakenAsPeopleTypeThem) {
  for (const char* yes : {"true", "yes", "on", "ON", "1"})
    EXPECT_EQ(std::get<bool>(parseFieldValue(yes, false)), true) << yes;
  for (const char* no : {"false", "no", "Off", "0"})
    EXPECT_EQ(std::get<bool>(parseFieldValue(no, true)), false) << no;
  EXPECT_EQ(std::get<int>(parseFieldValue("1e4", 0)), 10000);
  EXPECT_EQ(std::get<int>(parseFieldValue("+7", 0)), 7);
  EXPECT_EQ(std::get<double>(parseFieldValue(".5", 0.0)), 0.5);
  EXPECT_EQ(std::get<double>(parseFieldValue("3", 0.0)), 3.0);
  EXPECT_EQ(std::get<std::string>(parseFieldValue("007", std::string())), "007");
  EXPECT_EQ(std::get<std::string>(parseFieldValue("\"a b\"", std::string())), "a b");
  // What does not fit is left for the field to refuse.
  EXPECT_EQ(std::get<std::string>(parseFieldValue("maybe", false)), "maybe");
  EXPECT_EQ(std::get<double>(parseFieldValue("1.5", 0)), 1.5);
  EXPECT_EQ(std::get<std::string>(parseFieldValue("many", 0)), "many");
  EXPECT_EQ(std::get<double>(parseFieldValue("1e300", 0)), 1e300);
}

TEST(Fields, ANumberThatNoIntegerHoldsDoesNotWrap) {
  EXPECT_EQ(std::get<double>(parseFieldValue("18446744073709551615")), 18446744073709551615.0);
  EXPECT_EQ(std::get<double>(parseFieldValue("4294967297")), 4294967297.0);
  EXPECT_EQ(std::get<double>(parseFieldValue("-4294967297")), -4294967297.0);
  EXPECT_EQ(std::get<int>(parseFieldValue("2147483647")), 2147483647);
}

TEST(CountText, SaysOneAndMany) {
  EXPECT_EQ(countText(1, "frame"), "1 frame");
  EXPECT_EQ(countText(0, "frame"), "0 frames");
  EXPECT_EQ(countText(std::size_t{1200}, "entry", "entries"), "1,200 entries");
  EXPECT_EQ(countText(1, "file was", "files were"), "1 file was");
  EXPECT_EQ(countText(-1234567, "step"), "-1,234,567 steps");
  EXPECT_EQ(nounText(1, "frame") + " " + nounText(2, "frame"), "frame frames");
}

TEST(Progress, PartsCoverTheirShareAndReportsNeverGoBack) {
  std::vector<double> seen;
  Progress p({}, [&](const ProgressReport& r) { seen.push_back(r.fraction); });
  for (int i = 0; i < 2; ++i) {
    Progress part = p.part(0.5, "half");
    part.expect(4);
    for (int k = 0; k < 4; ++k) part.step();
  }
  ASSERT_GE(seen.size(), 3u);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_NEAR(seen.back(), 1.0, 1e-9);
}

TEST(Progress, ToReportIsToCheck) {
  std::stop_source stop;
  Progress p(stop.get_token());
  p.expect(3);
  p.step();
  stop.request_stop();
  EXPECT_THROW(p.step(), Cancelled);
  EXPECT_TRUE(p.stopRequested());
}

double sumOfRoots(int threads) {
  setThreadCount(threads);
  const double sum = parallelReduce(
      100001, 97, 0.0,
      [](std::size_t begin, std::size_t end) {
        double s = 0;
        for (std::size_t i = begin; i < end; ++i) s += std::sqrt(static_cast<double>(i));
        return s;
      },
      [](double a, double b) { return a + b; });
  setThreadCount(0);
  return sum;
}

TEST(Parallel, ReductionsGiveTheSameBitsForAnyNumberOfThreads) { EXPECT_EQ(sumOfRoots(1), sumOfRoots(2)); }

TEST(Parallel, EveryIndexIsVisitedOnceAndErrorsArrive) {
  std::vector<std::atomic<int>> seen(1000);
  parallelFor(seen.size(), 7, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++seen[i];
  });
  for (const auto& s : seen) EXPECT_EQ(s, 1);
  EXPECT_THROW(parallelFor(10, 1, [](std::size_t, std::size_t) { throw Error(Error::Kind::Data, "x"); }),
               Error);
}

TEST(Random, DependsOnEveryKeyAndIsEven) {
  EXPECT_NE(RandomStream(1, 2, 3).bits(0), RandomStream(1, 3, 2).bits(0));
  EXPECT_NE(RandomStream(1, 2).bits(0), RandomStream(1, 2).bits(1));
  EXPECT_EQ(RandomStream(1, 2).bits(5), RandomStream(1, 2).bits(5));
  const RandomStream r(9);
  double mean = 0, normal = 0, square = 0;
  for (int i = 0; i < 20000; ++i) {
    mean += r.uniform(i) / 20000;
    normal += r.normal(50000 + i) / 20000;
    square += r.normal(50000 + i) * r.normal(50000 + i) / 20000;
    EXPECT_LT(r.below(i, 7), 7u);
  }
  EXPECT_NEAR(mean, 0.5, 0.01);
  EXPECT_NEAR(normal, 0, 0.03);
  EXPECT_NEAR(square, 1, 0.05);
}

TEST(Digest, OfAStreamIsThatOfTheWholeAndReadsBack) {
  Hasher h;
  h.add("one ");
  h.add("two");
  EXPECT_EQ(h.digest(), digestOf("one two"));
  EXPECT_EQ(parseDigest(h.digest().hex()), h.digest());
  EXPECT_THROW(parseDigest("xyz"), Error);
}

}  // namespace
}  // namespace beam
