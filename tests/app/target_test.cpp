// SPDX-License-Identifier: Apache-2.0
// Where `beam` writes: never into a capture or a project, and over nobody's file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/io/image_file.h"
#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

void put(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

class Target : public ::testing::Test {
 protected:
  Said beam(const Words& words) const { return Running(folder_.path(), words).wait(); }
  std::string project() const { return SolvedHouse::project().string(); }
  std::string at(const char* name) const { return (folder_.path() / name).string(); }

  // Every command that writes, with `place` as where.
  std::vector<Words> writers(const std::string& file, const std::string& folder) const {
    const std::string capture = SampleHouse::capture().string();
    return {{"evaluate", project(), "--ground-truth", capture, "--json-file", file},
            {"status", project(), "--json-file", file},
            {"clean", project(), "--json-file", file},
            {"stages", "--json-file", file},
            {"check", capture, "--json-file", file},
            {"report", project(), "--out", file},
            {"render", project(), "--channels", "depth", "--out", folder},
            {"export", project(), "--out", folder},
            {"sample", folder, "--cameras", "2", "--size", "16x16", "--samples", "1"},
            {"new", folder, "--capture", capture},
            Words{"process", capture, "--out", folder} + tiny()};
  }
  void expectRefused(const std::string& file, const std::string& folder, const fs::path& untouched,
                     const char* hint) const {
    const auto before = filesIn(untouched);
    for (const Words& words : writers(file, folder)) {
      const Said said = beam(words);
      EXPECT_EQ(said.code, 2) << words[0] << "\n" << said.err;
      EXPECT_THAT(said.err, HasSubstr(hint)) << words[0];
    }
    EXPECT_EQ(filesIn(untouched), before);
  }

  TempDir folder_;
};

TEST_F(Target, InACaptureIsRefusedByEveryCommand) {
  const fs::path capture = SampleHouse::capture();
  expectRefused((capture / "dataset.json").string(), (capture / "out").string(), capture, "capture");
  expectRefused((capture / "images/new/x.json").string(), (capture / "images/deep/out").string(), capture,
                "capture");
}

TEST_F(Target, InAProjectIsRefusedByEveryCommand) {
  const fs::path p = project();
  expectRefused((p / "project.json").string(), (p / "results/mine").string(), p, "project");
}

TEST_F(Target, ThroughALinkIsWhereTheLinkLeads) {
  fs::create_directory_symlink(SampleHouse::capture(), at("link"));
  expectRefused(at("link/dataset.json"), at("link/out"), SampleHouse::capture(), "capture");
}

TEST_F(Target, BelowTheFolderThatWasGivenIsLookedAtAsWell) {
  const fs::path capture = SampleHouse::capture();
  const auto before = filesIn(capture);
  const auto renderTo = [&](const char* out) {
    return beam({"render", project(), "--channels", "rgb,mesh", "--out", at(out)});
  };
  fs::create_directories(at("a/rgb"));
  fs::create_directory_symlink(capture, at("a/rgb/test00"));
  fs::create_directories(at("b"));
  fs::create_directory_symlink(SolvedHouse::project(), at("b/mesh"));
  for (const char* out : {"a", "b"}) {
    const Said said = renderTo(out);
    EXPECT_EQ(said.code, 2) << out;
    EXPECT_THAT(said.err, HasSubstr("which is never written")) << out;
  }
  put(at("c"), "");
  fs::create_directories(at("d"));
  put(at("d/rgb"), "my own words");
  EXPECT_EQ(renderTo("d").code, 74) << "a file where a folder is wanted";
  EXPECT_FALSE(fs::exists(at("d/mesh"))) << "before the work";
  EXPECT_EQ(filesIn(capture), before);
}

TEST_F(Target, PhotographsOutsideOfTheirCaptureAreNotReplacedWithForceEither) {
  const fs::path capture = at("capture"), photos = at("photos/rgb");
  fs::create_directories(capture);
  fs::create_directories(at("photos"));
  fs::copy(SampleHouse::capture() / "images", photos, fs::copy_options::recursive);
  nlohmann::json description = nlohmann::json::parse(textOf(SampleHouse::capture() / "transforms.json"));
  for (nlohmann::json& frame : description["frames"]) {
    const std::string path = frame["file_path"];
    frame["file_path"] = "../photos/rgb/" + path.substr(path.find('/') + 1);
    frame["mask_path"] = (SampleHouse::capture() / std::string(frame["mask_path"])).string();
  }
  put(capture / "transforms.json", description.dump());
  const Said made =
      beam(Words{"process", capture.string(), "--out", at("e.beam"), "--until", "surface"} + tiny());
  ASSERT_EQ(made.code, 0) << made.err;
  const auto before = filesIn(at("photos"));
  const Said said = beam({"render", at("e.beam"), "--cameras", "all", "--out", at("photos"), "--force"});
  EXPECT_EQ(said.code, 2) << said.err;
  EXPECT_THAT(said.err, HasSubstr("photographs of the capture"));
  EXPECT_EQ(filesIn(at("photos")), before);
}

TEST_F(Target, InAProjectThatLostItsDocumentIsRefused) {
  fs::create_directories(at("lost.beam"));
  fs::copy(SolvedHouse::project() / "results", at("lost.beam/results"), fs::copy_options::recursive);
  const Said said = beam({"export", project(), "--out", at("lost.beam/results/mine")});
  EXPECT_EQ(said.code, 2) << said.err;
  EXPECT_THAT(said.err, HasSubstr("lies in the project"));
}

TEST_F(Target, ATextThatSpeaksOfTheProgramAndALinkToNowhereAreNobodysToReplace) {
  const Words report = {"report", project(), "--out", at("notes.html")};
  put(at("notes.html"), "BEAM Studio, beam report: what I think of it");
  EXPECT_EQ(beam(report).code, 2);
  EXPECT_THAT(textOf(at("notes.html")), HasSubstr("what I think"));
  fs::remove(at("notes.html"));
  fs::create_symlink("away.html", at("notes.html"));
  EXPECT_EQ(beam(report).code, 2);
  EXPECT_TRUE(fs::is_symlink(at("notes.html")));
  EXPECT_EQ(beam(report + Words{"--force"}).code, 0);
}

TEST_F(Target, ThatAnotherWroteIsReplacedWithForceAlone) {
  const std::string capture = SampleHouse::capture().string();
  for (const Words& words :
       {Words{"evaluate", project(), "--ground-truth", capture, "--json-file", at("mine")},
        Words{"status", project(), "--json-file", at("mine")},
        Words{"check", capture, "--json-file", at("mine")},
        Words{"report", project(), "--out", at("mine")}}) {
    put(at("mine"), "my own words");
    const Said said = beam(words);
    EXPECT_EQ(said.code, 2) << words[0];
    EXPECT_THAT(said.err, AllOf(HasSubstr("mine"), HasSubstr("--force"))) << words[0];
    EXPECT_EQ(textOf(at("mine")), "my own words") << words[0];
    EXPECT_EQ(beam(words + Words{"--force"}).code, 0) << words[0];
    EXPECT_EQ(beam(words).code, 0) << words[0] << ": its own file";
  }
  const Words render = {"render", project(), "--channels", "rgb,depth,mesh", "--out", at("pictures")};
  const Words splats = {"export", project(), "--out", at("splats")};
  for (const Words& words : {render, splats}) {
    EXPECT_EQ(beam(words).code, 0);
    EXPECT_EQ(beam(words).code, 0) << "its own files";
  }
  for (const char* file :
       {"pictures/rgb/test00/000000.png", "pictures/mesh/000000.ply", "splats/frame.000000.ply"}) {
    put(at(file), "my own words");
    EXPECT_EQ(beam(fs::path(file).begin()->string() == "splats" ? splats : render).code, 2) << file;
    EXPECT_EQ(textOf(at(file)), "my own words");
    fs::remove(at(file));
  }
}

TEST_F(Target, IsLookedAtBeforeTheWorkAndItsFoldersAreMade) {
  const std::string capture = SampleHouse::capture().string();
  ASSERT_EQ(beam({"new", at("empty.beam"), "--capture", capture}).code, 0);
  put(at("mine"), "x");
  EXPECT_EQ(beam({"report", at("empty.beam"), "--out", at("mine")}).code, 2) << "not: nothing is solved";
  put(at("file"), "x");
  EXPECT_EQ(beam({"report", project(), "--out", at("file/below.html")}).code, 74);
  EXPECT_EQ(beam({"report", project(), "--out", at("new/deep/page.html")}).code, 0);
  EXPECT_EQ(beam({"status", project(), "--json-file", at("other/s.json")}).code, 0);
  EXPECT_EQ(beam({"report", project(), "--out", at("new")}).code, 2) << "a folder";
  for (const char* folder : {"none/", "none/.", "none/deep/", "new/"}) {
    const Said said = beam({"report", project(), "--out", at(folder)});
    EXPECT_EQ(said.code, 2) << folder << said.err;
    EXPECT_THAT(said.err, HasSubstr("name of a file")) << folder;
    EXPECT_EQ(beam({"status", project(), "--json-file", at(folder)}).code, 2) << folder;
  }
  EXPECT_FALSE(fs::exists(at("none")));
}

TEST_F(Target, JsonGoesToStandardOutputOrIntoAFileAndSaysWhoWroteIt) {
  const std::string capture = SampleHouse::capture().string();
  for (const Words& words : {Words{"evaluate", project(), "--ground-truth", capture},
                             Words{"status", project()}, Words{"check", capture}, Words{"stages"}}) {
    const Said words_said = beam(words), json = beam(words + Words{"--json"});
    EXPECT_EQ(json.code, 0) << json.err;
    const nlohmann::json parsed = nlohmann::json::parse(json.out);
    EXPECT_EQ(beam(words + Words{"--json-file", "-"}).out, json.out) << words[0];
    const Said both = beam(words + Words{"--json-file", at(words[0].c_str())});
    EXPECT_EQ(both.out, words_said.out) << words[0];
    EXPECT_EQ(nlohmann::json::parse(textOf(at(words[0].c_str()))), parsed) << words[0];
    if (parsed.is_object()) {
      EXPECT_EQ(parsed.at("written_by").at("program"), "BEAM Studio, beam " + words[0]);
    }
  }
}

TEST_F(Target, PicturesSayWhatTheyAre) {
  ASSERT_EQ(beam({"render", project(), "--channels", "rgb,depth", "--out", at("pictures")}).code, 0);
  const std::string png = textOf(at("pictures/rgb/test00/000000.png"));
  for (const char* text : {"sRGB", "tEXtSoftware", "BEAM Studio, beam render", "test00", "000000"})
    EXPECT_THAT(png, HasSubstr(text));
  EXPECT_EQ(readPhoto(at("pictures/rgb/test00/000000.png")).width, 48) << "another program still reads it";
  const std::string exr = textOf(at("pictures/depth/test00/000000.exr"));
  for (const char* text :
       {"Software", "BEAM Studio, beam render", "camera", "test00", "unit", "axes", "capture"})
    EXPECT_THAT(exr, HasSubstr(text));
}

TEST_F(Target, CheckIsStrictOnRequest) {
  const std::string capture = SampleHouse::capture().string();
  EXPECT_EQ(beam({"check", capture, "--strict"}).code, 0);
  EXPECT_EQ(beam({"check", capture, "--unit", "mm"}).code, 0);
  EXPECT_EQ(beam({"check", capture, "--unit", "mm", "--strict"}).code, 65);
}

}  // namespace
}  // namespace beam::testing
