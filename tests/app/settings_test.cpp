// SPDX-License-Identifier: Apache-2.0
// Settings that can be seen and taken back, what a run would cost, why something is pending, and the forms in
// which people type.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

// A project with one frame solved as far as the surface, made once and copied for each test.
class Settings : public ::testing::Test {
 protected:
  void SetUp() override { fs::copy(SolvedHouse::project(), project(), fs::copy_options::recursive); }

  Said beam(const Words& words) const { return Running(folder_.path(), words).wait(); }
  std::string project() const { return (folder_.path() / "p.beam").string(); }
  std::string at(const char* name) const { return (folder_.path() / name).string(); }
  // Where a value in force comes from.
  std::string originOf(const std::string& key) const {
    const Json stages = Json::parse(beam({"stages", project(), "--json"}).out)["stages"];
    for (const Json& stage : stages)
      for (const Json& setting : stage["settings"])
        if (setting["key"] == key) return setting["from"].get<std::string>() + " " + setting["value"].dump();
    return "";
  }

  TempDir folder_;
};

TEST_F(Settings, OfAProjectAreSeenWithTheirOriginAndOfNoneWithThePresets) {
  EXPECT_EQ(originOf("surface.iterations"), "set 20");
  EXPECT_EQ(originOf("light.gain"), "default 1.0");
  const Said plain = beam({"stages", "--json"});
  const Json stages = Json::parse(plain.out);
  EXPECT_THAT(plain.out, AllOf(HasSubstr("\"draft\""), HasSubstr("\"paper\""), Not(HasSubstr("\"from\""))));
  EXPECT_THAT(beam({"stages"}).out, HasSubstr("draft "));
}

TEST_F(Settings, ThatCannotBeAreNamedWithTheirFileAndCanBeMended) {
  const fs::path file = fs::path(project()) / "project.json";
  const auto write = [&](auto&& change) {
    Json document = Json::parse(textOf(file));
    change(document);
    std::ofstream(file) << document.dump();
  };
  const auto expectNamed = [&](const char* what, const Words& mend) {
    for (const char* command : {"status", "run", "render"}) {
      const Words out = command == std::string("render") ? Words{"--out", at("out")} : Words{};
      const Said said = beam(Words{command, project()} + out);
      EXPECT_EQ(said.code, 65) << command << said.err;
      EXPECT_THAT(said.err, AllOf(HasSubstr("project.json"), HasSubstr(what), HasSubstr(mend[0])));
    }
    const Said mended = beam(Words{"run", project(), "--until", "capture"} + mend);
    EXPECT_EQ(mended.code, 0) << mended.err;
    EXPECT_EQ(beam({"status", project()}).code, 0);
  };
  write([](Json& j) { j["preset"] = "nope"; });
  expectNamed("nope", {"--preset", "draft"});
  write([](Json& j) { j["settings"]["surface.iterations"] = -5; });
  expectNamed("surface.iterations", {"--unset", "surface.iterations"});
  write([](Json& j) { j["settings"]["surface.nobody"] = 1; });
  expectNamed("surface.nobody", {"--unset", "surface.nobody"});
  write([](Json& j) { j["hold_out"] = {"nobody"}; });
  expectNamed("nobody", {"--hold-out", "none"});
}

TEST_F(Settings, OfAnotherTypeAreBrokenAndNotNone) {
  const fs::path file = fs::path(project()) / "project.json";
  const std::string good = textOf(file);
  for (const auto& [key, value] : std::map<std::string, Json>{
           {"settings", nullptr}, {"takes", nullptr}, {"takes", Json::object()}, {"settings", 3}}) {
    Json document = Json::parse(good);
    document[key] = value;
    std::ofstream(file) << document.dump();
    const Said said = beam({"status", project()});
    EXPECT_EQ(said.code, 65) << key << value;
    EXPECT_THAT(said.err, AllOf(HasSubstr("broken"), HasSubstr(key))) << value;
  }
  Json document = Json::parse(good);
  document["takes"] = {{{"first", "000000"}, {"last", "000001"}, {"step", 4294967297}}};
  std::ofstream(file) << document.dump();
  EXPECT_THAT(beam({"status", project()}).err, HasSubstr("step of a take"));
}

TEST_F(Settings, AnEmptyWordIsNotAFlagThatWasNotGiven) {
  for (const Words& words :
       {Words{"render", project(), "--out", at("o"), "--environment", ""}, Words{"stages", "--json-file", ""},
        Words{"evaluate", project(), "--ground-truth", ""}, Words{"status", ""}}) {
    const Said said = beam(words);
    EXPECT_EQ(said.code, 2) << words[0];
    EXPECT_THAT(said.err, HasSubstr("is empty")) << words[0];
  }
}

TEST_F(Settings, ThatARunSavesAreSaid) {
  const Words run = {"run", project(), "--until", "capture", "--set", "surface.cap=500"};
  EXPECT_THAT(beam(run + Words{"--dry-run"}).err, HasSubstr("would be saved: surface.cap 400 → 500"));
  EXPECT_THAT(beam(run).err, HasSubstr("saved: surface.cap 400 → 500"));
  EXPECT_THAT(beam(run).err, Not(HasSubstr("saved:")));
  const Words other = {"run", project(), "--until", "capture", "--set", "surface.cap=600"};
  fs::remove_all(fs::path(project()) / "history");
  std::ofstream(fs::path(project()) / "history") << "in the way";
  const Said failed = beam(other);
  EXPECT_EQ(failed.code, 74) << failed.err;
  EXPECT_THAT(failed.err, Not(HasSubstr("saved:")));
}

TEST_F(Settings, TakesOfFramesThatAreNotThereAreSaid) {
  const fs::path file = fs::path(project()) / "project.json";
  Json document = Json::parse(textOf(file));
  document["takes"].push_back({{"first", "000000"}, {"last", "999999"}, {"step", 1}});
  std::ofstream(file) << document.dump();
  const Said said = beam({"status", project()});
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, HasSubstr("the capture has no frame 999999"));
}

TEST_F(Settings, APlaceThatIsNamedInOtherBytesThanUtf8IsNotSaved) {
  const std::string odd = at("caf\xe9");
  fs::copy(SampleHouse::capture(), odd, fs::copy_options::recursive);
  const Said said = beam({"new", at("n.beam"), "--capture", odd});
  EXPECT_EQ(said.code, 2) << said.err;
  EXPECT_THAT(said.err, HasSubstr("UTF-8"));
  EXPECT_FALSE(fs::exists(at("n.beam")));
  EXPECT_NO_THROW(Json::parse(beam({"check", odd, "--json"}).out));
}

TEST_F(Settings, OfAPanoramaThatIsAwayTheStatusIsToldAsJsonToo) {
  fs::copy(SampleHouse::capture() / "environment.exr", at("light.exr"));
  ASSERT_EQ(beam({"run", project(), "--until", "capture", "--environment", at("light.exr")}).code, 0);
  fs::remove(at("light.exr"));
  const Said words = beam({"status", project()}), json = beam({"status", project(), "--json"});
  EXPECT_EQ(words.code, 0) << words.err;
  EXPECT_EQ(json.code, 0) << json.err;
  EXPECT_THAT(json.out, HasSubstr("\"blocked\""));
}

TEST_F(Settings, AreTakenBackOneByOneAndAllAtOnce) {
  EXPECT_EQ(beam({"run", project(), "--until", "capture", "--unset", "surface.iterations"}).code, 0);
  EXPECT_THAT(originOf("surface.iterations"), HasSubstr("preset standard"));
  EXPECT_EQ(originOf("surface.cap"), "set 400");
  EXPECT_EQ(beam({"run", project(), "--until", "capture", "--preset", "draft", "--reset"}).code, 0);
  EXPECT_THAT(originOf("surface.cap"), HasSubstr("preset draft"));
  EXPECT_THAT(originOf("surface.iterations"), HasSubstr("preset draft"));
  const Said unknown = beam({"run", project(), "--unset", "surface.iteration"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("surface.iterations"));
  EXPECT_EQ(beam({"run", project(), "--unset", "surface.cap", "--set", "surface.cap=9"}).code, 2);
}

TEST_F(Settings, ThatChangedLeaveTheResultsUsableWithAWarning) {
  ASSERT_EQ(beam({"run", project(), "--until", "capture", "--set", "surface.iterations=25"}).code, 0);
  const std::string change = "surface.iterations 20 → 25";
  for (const Words& words :
       std::vector<Words>{{"render", project(), "--cameras", "all", "--out", at("pictures")},
                          {"export", project(), "--out", at("splats")},
                          {"evaluate", project(), "--ground-truth", SampleHouse::capture().string()},
                          {"report", project(), "--out", at("page.html")}}) {
    const Said said = beam(words);
    EXPECT_EQ(said.code, 0) << words[0] << said.err;
    EXPECT_THAT(said.err, AllOf(HasSubstr("warning:"), HasSubstr(change))) << words[0];
    const Said strict = beam(words + Words{"--strict"});
    EXPECT_EQ(strict.code, 65) << words[0] << strict.err;
    EXPECT_THAT(strict.err, HasSubstr(change)) << words[0];
  }
  EXPECT_THAT(textOf(at("page.html")), HasSubstr(change));
  EXPECT_THAT(beam({"status", project()}).out, HasSubstr("because " + change));
}

TEST_F(Settings, ADryRunSaysWhatThereIsToDoAndChangesNothing) {
  const auto before = filesIn(project());
  const Said said = beam({"run", project(), "--dry-run", "--set", "surface.iterations=25"});
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, AllOf(HasSubstr("surface.fit"), HasSubstr("results to compute")));
  const Json plan = Json::parse(beam({"run", project(), "--dry-run", "--json"}).out);
  EXPECT_EQ(plan["frames"], 2);
  EXPECT_GT(plan["results_missing"], 0);
  EXPECT_EQ(filesIn(project()), before);
  const Said fresh = beam({"process", SampleHouse::capture().string(), "--out", at("new.beam"), "--dry-run"});
  EXPECT_EQ(fresh.code, 0) << fresh.err;
  EXPECT_FALSE(fs::exists(at("new.beam")));
}

TEST_F(Settings, ARunTellsItsEventsAsJsonLines) {
  const Said said = beam({"run", project(), "--until", "capture", "--json"});
  EXPECT_EQ(said.code, 0) << said.err;
  std::istringstream lines(said.out);
  std::vector<std::string> events;
  Json last;
  for (std::string line; std::getline(lines, line);) {
    last = Json::parse(line);
    events.push_back(last.at("event"));
  }
  EXPECT_THAT(events, ::testing::Contains("step"));
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.back(), "finished");
  EXPECT_EQ(last["exit_code"], 0);
  EXPECT_EQ(last["outcome"], "done");
}

TEST_F(Settings, APictureThatChangedIsNamed) {
  const fs::path capture = folder_.path() / "capture";
  fs::copy(SampleHouse::capture(), capture, fs::copy_options::recursive);
  ASSERT_EQ(
      beam(Words{"process", capture.string(), "--out", at("own.beam"), "--until", "surface"} + tiny()).code,
      0);
  fs::path picture;
  for (const auto& entry : fs::recursive_directory_iterator(capture / "images")) {
    if (entry.is_regular_file() && entry.path().stem() == "000000") picture = entry.path();
  }
  fs::path other = picture;
  other.replace_filename("000001" + picture.extension().string());
  fs::copy_file(other, picture, fs::copy_options::overwrite_existing);
  EXPECT_THAT(beam({"status", at("own.beam")}).out,
              HasSubstr(picture.lexically_relative(capture).generic_string() + " changed"));
}

TEST_F(Settings, AreTakenInTheFormsThatPeopleType) {
  const auto runs = [&](const Words& words) {
    return beam(Words{"run", project(), "--until", "capture"} + words);
  };
  EXPECT_EQ(runs({"--set", "surface.iterations=1e2"}).code, 0);
  EXPECT_EQ(originOf("surface.iterations"), "set 100");
  EXPECT_EQ(runs({"--set", "light.gain=.5"}).code, 0);
  EXPECT_EQ(originOf("light.gain"), "set 0.5");
  EXPECT_EQ(runs({"--frames", " 0 - ", "--up", "+z", "--up", "+y"}).code, 0) << "the last --up holds";
  EXPECT_EQ(runs({"--frames", "ALL"}).code, 0);
  EXPECT_EQ(runs({"--frames", ""}).code, 2);
  EXPECT_EQ(runs({"--hold-out", ""}).code, 2);
}

TEST_F(Settings, CamerasAreChosenByPatternsAndWordsTogether) {
  const auto draws = [&](const char* cameras) {
    return beam(
        {"render", project(), "--channels", "alpha", "--cameras", cameras, "--out", at("p"), "--force"});
  };
  EXPECT_THAT(draws("train, *0").out, HasSubstr("of 6 cameras"));
  EXPECT_THAT(draws("ALL").out, HasSubstr("cameras"));
  for (const char* nothing : {"", " , ", "zebra*", "zebra"}) EXPECT_EQ(draws(nothing).code, 2) << nothing;
  for (const char* nothing : {"zebra*", "zebra"})
    EXPECT_THAT(draws(nothing).err, HasSubstr("the cameras are cam00, ")) << nothing;
  EXPECT_THAT(beam({"check", SampleHouse::capture().string(), "--hold-out", "zebra"}).err,
              HasSubstr("the cameras are cam00, "));
  EXPECT_EQ(beam({"render", project(), "--channels", "", "--out", at("p")}).code, 2);
  EXPECT_EQ(beam({"check", SampleHouse::capture().string(), "--hold-out", "none", "--up", "+y"}).code, 0);
}

TEST_F(Settings, TheWrongKindOfThingIsToldWhatItIs) {
  const std::string capture = SampleHouse::capture().string();
  EXPECT_THAT(beam({"status", capture}).err, AllOf(HasSubstr("is a capture"), HasSubstr("beam process")));
  EXPECT_THAT(beam({"check", project()}).err, AllOf(HasSubstr("is a project"), HasSubstr("beam status")));
  EXPECT_THAT(beam({"process", project(), "--out", at("x.beam")}).err, HasSubstr("is a project"));
  EXPECT_THAT(beam({"process", at("nowhere"), "--out", at("x.beam")}).err, HasSubstr("is not there"));
  std::ofstream(at("film.mp4")) << "film";
  EXPECT_THAT(beam({"process", at("film.mp4"), "--out", at("x.beam")}).err, HasSubstr("is a video"));
  for (const Words& words : std::vector<Words>{{"status", capture}, {"check", project()}})
    EXPECT_EQ(beam(words).code, 65);
}

TEST_F(Settings, CheckSaysWhatAFileIsThatItDoesNotLookAt) {
  const auto check = [&](const char* name, const std::string& bytes) {
    std::ofstream(at(name)) << bytes;
    const Said said = beam({"check", at(name)});
    EXPECT_EQ(said.code, 65) << name;
    return said.err;
  };
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
  EXPECT_THAT(check("m.ply", ply + "element face 2\nproperty list uchar int vertex_indices\nend_header\n"),
              HasSubstr("is a mesh (1 vertex, 2 triangles)"));
  EXPECT_THAT(check("p.ply", ply + "end_header\n0\n"),
              AllOf(HasSubstr("is a point cloud"), HasSubstr("scale_0")));
  EXPECT_THAT(check("s.spz", "x"), AllOf(HasSubstr("splats of a kind that is not read"), HasSubstr(".ply")));
  EXPECT_THAT(check("s.sog", "PK"), HasSubstr("splats of a kind that is not read"));
  EXPECT_THAT(check("environment.png", "x"),
              AllOf(HasSubstr("is a PNG or JPEG picture"), HasSubstr(".exr or .hdr")));
  EXPECT_THAT(check("dataset.json", "{}"), HasSubstr("name the folder"));
}

TEST_F(Settings, CheckEndsWithAnErrorWhereNoPictureCanBeUsed) {
  std::filesystem::copy(SampleHouse::capture(), at("c"), std::filesystem::copy_options::recursive);
  EXPECT_EQ(beam({"check", at("c")}).code, 0);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(at("c") + "/images"))
    if (entry.is_regular_file()) std::ofstream(entry.path()) << "no picture";
  const Said said = beam({"check", at("c")});
  EXPECT_EQ(said.code, 65);
  EXPECT_THAT(said.err, HasSubstr("cannot be processed"));
}

TEST_F(Settings, APanoramaIsReadBeforeTheProjectIsMade) {
  std::ofstream(at("broken.exr")) << "no picture";
  const Said said = beam(
      {"process", SampleHouse::capture().string(), "--out", at("x.beam"), "--environment", at("broken.exr")});
  EXPECT_EQ(said.code, 65) << said.err;
  EXPECT_FALSE(fs::exists(at("x.beam")));
  const Said folder =
      beam({"new", at("x.beam"), "--capture", SampleHouse::capture().string(), "--environment", project()});
  EXPECT_EQ(folder.code, 65);
  EXPECT_THAT(folder.err, HasSubstr("is a project"));
}

}  // namespace
}  // namespace beam::testing
