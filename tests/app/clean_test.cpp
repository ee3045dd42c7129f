// SPDX-License-Identifier: Apache-2.0
// `beam clean` and what `beam status` says of the disk, on projects whose settings went to and fro.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using Json = nlohmann::json;

std::uintmax_t bytesOf(const std::map<std::string, std::string>& files) {
  std::uintmax_t bytes = 0;
  for (const auto& [name, text] : files) bytes += text.size();
  return bytes;
}

// Results by path with their bytes, without the records, which hold times.
std::map<std::string, std::string> productsOf(const fs::path& project) {
  auto files = filesIn(project / "results");
  std::erase_if(files, [](const auto& file) { return file.first.ends_with("result.json"); });
  return files;
}

class Clean : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    house_ = std::make_unique<TempDir>();
    const Words there = {"--set", "surface.iterations=15"}, back = {"--set", "surface.iterations=20"};
    for (const Words& settings : {Words{}, there, back}) expectDone(settings, "fro.beam");
    expectDone({}, "only.beam");
  }
  static void TearDownTestSuite() { house_.reset(); }
  static Words solve(const fs::path& project) {
    return Words{"process", SampleHouse::capture().string(), "--out", project.string(), "--until",
                 "surface"} +
           tiny();
  }
  static void expectDone(const Words& settings, const char* project) {
    const Said said = Running(house_->path(), solve(house_->path() / project) + settings).wait();
    ASSERT_EQ(said.code, 0) << said.err;
  }

  Clean() {
    fs::copy(house_->path() / "fro.beam", project(), fs::copy_options::recursive);
    fs::copy(house_->path() / "only.beam", only(), fs::copy_options::recursive);
  }
  Said beam(const Words& words) const { return Running(folder_.path(), words).wait(); }
  fs::path project() const { return folder_.path() / "p.beam"; }
  fs::path only() const { return folder_.path() / "only.beam"; }
  Json status(const fs::path& of) const { return Json::parse(beam({"status", of.string(), "--json"}).out); }
  // A result that no setting in force refers to.
  fs::path other() const {
    for (const auto& result : fs::directory_iterator(project() / "results")) {
      if (!fs::exists(only() / "results" / result.path().filename())) return result.path();
    }
    return {};
  }

  TempDir folder_;
  static std::unique_ptr<TempDir> house_;
};
std::unique_ptr<TempDir> Clean::house_;

TEST_F(Clean, WhatOfTheCaptureIsAwayCostsNothing) {
  const fs::path capture = folder_.path() / "capture";
  fs::copy(SampleHouse::capture(), capture, fs::copy_options::recursive);
  const fs::path mine = folder_.path() / "mine.beam";
  Words solve = {"process", capture.string(), "--out", mine.string(), "--until", "track"};
  solve = solve + tinyTake() + Words{"--frames", "0-1"};
  ASSERT_EQ(beam(solve).code, 0);
  const auto before = filesIn(mine / "results");
  std::string camera;
  for (const auto& entry : fs::directory_iterator(capture / "images"))
    if (entry.path().filename().string().starts_with("cam")) camera = entry.path().filename().string();
  ASSERT_FALSE(camera.empty());
  const auto expectRefused = [&](const fs::path& away, const std::string& named) {
    fs::rename(capture / away, folder_.path() / "away");
    const Said said = beam({"clean", mine.string()});
    EXPECT_EQ(said.code, 65) << away << said.err;
    EXPECT_THAT(said.err, AllOf(HasSubstr(named), HasSubstr("put it back")));
    EXPECT_EQ(filesIn(mine / "results"), before);
    fs::rename(folder_.path() / "away", capture / away);
  };
  expectRefused(fs::path("images") / camera / "000001.png", camera + "/000001.png");
  expectRefused(fs::path("masks") / camera, camera + "/000000.png");
  // Half copied, or a folder of its name.
  const fs::path picture = capture / "images" / camera / "000001.png", whole = folder_.path() / "whole.png";
  fs::rename(picture, whole);
  for (const bool half : {true, false}) {
    if (half)
      std::ofstream(picture, std::ios::binary) << textOf(whole).substr(0, 500);
    else
      fs::create_directories(picture);
    const Said said = beam({"clean", mine.string()});
    EXPECT_EQ(said.code, 65) << half << said.err;
    EXPECT_THAT(said.err, HasSubstr(camera + "/000001.png"));
    EXPECT_EQ(filesIn(mine / "results"), before);
    fs::remove(picture);
  }
  fs::rename(whole, picture);
  EXPECT_EQ(Json::parse(beam({"clean", mine.string(), "--json"}).out)["removed"]["count"], 0);
  // Another capture in its place, with the same names.
  fs::rename(capture, folder_.path() / "first");
  ASSERT_EQ(beam({"sample", capture.string(), "--frames", "2", "--cameras", "6", "--size", "48x64",
                  "--samples", "4"})
                .code,
            0);
  const Said other = beam({"clean", mine.string()});
  EXPECT_EQ(other.code, 65) << other.err;
  EXPECT_THAT(other.err, HasSubstr("dataset.json"));
  EXPECT_THAT(beam({"status", mine.string()}).err, HasSubstr("not described as it was"));
  EXPECT_EQ(filesIn(mine / "results"), before);
}

TEST_F(Clean, RefusesToRemoveTheOnlyResultsOfAFrame) {
  // Both frames solved; one of them anew with other settings.
  ASSERT_EQ(beam(Words{"process", SampleHouse::capture().string(), "--out", project().string(), "--until",
                       "surface"} +
                 tinyTake())
                .code,
            0);
  const auto before = filesIn(project() / "results");
  ASSERT_EQ(
      beam({"run", project().string(), "--until", "surface", "--frames", "0", "--set", "surface.cap=300"})
          .code,
      0);
  const Said said = beam({"clean", project().string()});
  EXPECT_EQ(said.code, 2) << said.out;
  EXPECT_THAT(said.err, AllOf(HasSubstr("surface of frame 000001"), HasSubstr("--force")));
  for (const auto& [name, text] : before) EXPECT_TRUE(fs::exists(project() / "results" / name)) << name;
}

TEST_F(Clean, RefusesToRemoveTheOnlyResultsThatThereAre) {
  ASSERT_EQ(beam({"run", only().string(), "--until", "capture", "--set", "surface.iterations=77"}).code, 0);
  const auto before = filesIn(only() / "results");
  EXPECT_THAT(beam({"clean", only().string(), "--dry-run"}).err,
              HasSubstr("no result with the settings in force"));
  const Said said = beam({"clean", only().string()});
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, AllOf(HasSubstr("surface"), HasSubstr("--force")));
  EXPECT_TRUE(filesIn(only() / "results") == before);
  EXPECT_EQ(beam({"clean", only().string(), "--force"}).code, 0);
  EXPECT_LT(filesIn(only() / "results").size(), before.size());
}

TEST_F(Clean, LeavesTheResultsOfTheSettingsInForceByteForByteAndNothingElse) {
  const auto before = filesIn(project() / "results");
  ASSERT_GT(bytesOf(productsOf(project())), bytesOf(productsOf(only())));
  EXPECT_THAT(beam({"status", project().string()}).out, HasSubstr(" not in force (beam clean)"));
  const Json disk = status(project())["disk"];

  const Said said =
      beam({"clean", project().string(), "--json-file", (folder_.path() / "said.json").string()});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, AllOf(HasSubstr("surface"), HasSubstr("\nfreed "), HasSubstr(" stay")));
  EXPECT_TRUE(productsOf(project()) == productsOf(only()));
  for (const auto& [name, text] : filesIn(project() / "results"))
    EXPECT_TRUE(before.at(name) == text) << name;

  const Json json = Json::parse(textOf(folder_.path() / "said.json"));
  EXPECT_EQ(json["removed"]["bytes"], disk["other"]["bytes"]);
  EXPECT_EQ(json["freed_bytes"], bytesOf(before) - bytesOf(filesIn(project() / "results")));
  EXPECT_EQ(json["kept"]["bytes"], bytesOf(filesIn(project() / "results")));
  EXPECT_EQ(status(project())["disk"]["other"]["results"], 0);
  EXPECT_EQ(status(project())["disk"]["in_force"]["results"], status(only())["disk"]["in_force"]["results"]);
  const std::string words = beam({"status", project().string()}).out;
  EXPECT_THAT(words, Not(HasSubstr("other settings")));
  EXPECT_THAT(words, HasSubstr("surface.mesh       pending (1 frame); done 000000"));
  EXPECT_THAT(beam(solve(project())).err, HasSubstr("nothing to compute"));
}

TEST_F(Clean, OnlyLooksWithDryRun) {
  const auto before = filesIn(project());
  const Said said = beam({"clean", project().string(), "--dry-run"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, AllOf(HasSubstr("would free "), HasSubstr("nothing was removed")));
  EXPECT_TRUE(filesIn(project()) == before);
  const Json told = Json::parse(beam({"clean", project().string(), "--dry-run", "--json"}).out);
  EXPECT_TRUE(filesIn(project()) == before);
  const Json gone = Json::parse(beam({"clean", project().string(), "--json"}).out);
  EXPECT_EQ(told["stages"], gone["stages"]);
  EXPECT_TRUE(told["dry_run"] == true && gone["dry_run"] == false);
}

TEST_F(Clean, FinishesWhatAKillInTheMiddleLeft) {
  const fs::path result = other();
  ASSERT_FALSE(result.empty());
  const fs::path aside = result.parent_path() / fmt::format(".{}.123.tmp", result.filename().string());
  fs::rename(result, aside);
  fs::remove(aside / "result.json");
  EXPECT_EQ(beam({"status", project().string()}).code, 0);
  const Said said = beam({"clean", project().string()});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("also 1 unfinished folder ("));
  EXPECT_FALSE(fs::exists(aside));
  EXPECT_TRUE(productsOf(project()) == productsOf(only()));
}

TEST_F(Clean, WhileARunGoesOnEndsWith73AndNamesIt) {
  const Words endless = solve(project()) + Words{"--set", "surface.iterations=100000"};
  fs::create_directories(folder_.path() / "run");
  const Running run(folder_.path() / "run", endless);
  Said said;
  for (int attempt = 0; attempt < 600 && said.code != 73 && !run.ended(); ++attempt) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    bool leased = false;
    for (const auto& lease : fs::directory_iterator(project() / "leases")) leased |= lease.exists();
    if (leased) said = beam({"clean", project().string()});
  }
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait().code, 75);
  EXPECT_EQ(said.code, 73) << said.err;
  EXPECT_THAT(said.err, AllOf(HasSubstr("error: "), HasSubstr("process "), HasSubstr("wait until")));
}

TEST_F(Clean, OfAReadOnlyProjectIsAStorageError) {
  fs::permissions(project(), fs::perms(0555));
  const Said said = beam({"clean", project().string()});
  fs::permissions(project(), fs::perms(0755));
  EXPECT_EQ(said.code, 74);
  EXPECT_THAT(said.err, HasSubstr("read-only"));
}

TEST_F(Clean, ARecordSaysBesideItsKeyWhatItIs) {
  int told = 0;
  for (const auto& result : fs::directory_iterator(only() / "results")) {
    const std::string about = Json::parse(textOf(result.path() / "result.json"))["about"];
    EXPECT_THAT(about, MatchesRegex("[a-z]+\\.[a-z_]+ of (frame 000000|the whole project).*; .*"));
    told += about.starts_with("surface.fit") && about.find("surface.iterations = 20") != std::string::npos;
  }
  EXPECT_EQ(told, 1);
}

}  // namespace
}  // namespace beam::testing
