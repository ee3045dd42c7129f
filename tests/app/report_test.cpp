// SPDX-License-Identifier: Apache-2.0
// The scores of a run and the page that draws them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Report : public ::testing::Test {
 protected:
  TempDir folder_;
  fs::path at(const char* name) const { return folder_.path() / name; }
  Said beam(const Words& words) const { return Running(folder_.path(), words).wait(); }
  // Both frames as far as Surface, one camera held out; settings that take a moment.
  Said process(const fs::path& capture, const Words& more = {}) const {
    return beam(Words{"process", capture.string(), "--out", at("p.beam").string(), "--hold-out", "cam02",
                      "--until", "surface"} +
                tinyTake() + more);
  }
};

// The page with its embedded bytes cut out.
std::string withoutPictures(std::string page) {
  const std::string start = "base64,";
  for (std::size_t at = 0; (at = page.find(start, at)) != std::string::npos; at += start.size()) {
    const std::size_t begin = at + start.size();
    page.erase(begin, page.find('"', begin) - begin);
  }
  return page;
}

// Elements that are open at the end or closed out of turn; empty for well-formed XML.
Words wronglyNested(const std::string& page) {
  static const std::regex kTag(R"(<(/?)([a-zA-Z][a-zA-Z0-9]*)([^>]*)>)");
  Words open, wrong;
  for (std::sregex_iterator i(page.begin(), page.end(), kTag), end; i != end; ++i) {
    const std::string name = (*i)[2], rest = (*i)[3];
    if (rest.ends_with("/")) continue;
    if ((*i)[1].length() == 0) {
      open.push_back(name);
    } else if (!open.empty() && open.back() == name) {
      open.pop_back();
    } else {
      wrong.push_back("/" + name);
    }
  }
  wrong.insert(wrong.end(), open.begin(), open.end());
  return wrong;
}

TEST_F(Report, IsOneWellFormedPageThatLoadsNothing) {
  ASSERT_EQ(process(SampleHouse::capture()).code, 0);
  const Said said = beam({"report", at("p.beam").string(), "--out", at("report.html").string()});
  ASSERT_EQ(said.code, 0) << said.err;
  const std::string page = textOf(at("report.html"));
  EXPECT_THAT(page, HasSubstr("data:image/jpeg;base64,"));
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, HasSubstr("held out"));
  for (const char* outside : {"http:", "https:", "src=\"/", "href=", "url(", "@import", "<script"}) {
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  }
  EXPECT_THAT(wronglyNested(withoutPictures(page)), IsEmpty());
  ASSERT_EQ(beam({"report", at("p.beam").string(), "--out", at("again.html").string()}).code, 0);
  EXPECT_TRUE(textOf(at("again.html")) == page);
}

TEST_F(Report, NamesACameraThatDropsAFrame) {
  fs::copy(SampleHouse::capture(), at("capture"), fs::copy_options::recursive);
  fs::remove(at("capture") / "images/cam01/000001.png");
  ASSERT_EQ(process(at("capture")).code, 0);
  const Said said = beam({"report", at("p.beam").string(), "--out", at("report.html").string()});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("camera cam01 has no readable picture in 1 of 2 frames"));
  EXPECT_THAT(textOf(at("report.html")), HasSubstr("cam01 has no readable picture"));
}

TEST_F(Report, OfAProjectWithoutResultsSaysWhatToDo) {
  ASSERT_EQ(beam({"new", at("p.beam").string(), "--capture", SampleHouse::capture().string()}).code, 0);
  const Said said = beam({"report", at("p.beam").string(), "--out", at("report.html").string()});
  EXPECT_EQ(said.code, 65);
  EXPECT_THAT(said.err, HasSubstr("beam run"));
  EXPECT_FALSE(fs::exists(at("report.html")));
  ASSERT_EQ(beam({"run", at("p.beam").string(), "--until", "capture"}).code, 0);
  const Said screened = beam({"report", at("p.beam").string(), "--out", at("report.html").string()});
  EXPECT_EQ(screened.code, 65);
  EXPECT_THAT(screened.err, HasSubstr("no frame is solved yet"));
  EXPECT_FALSE(fs::exists(at("report.html")));
}

TEST_F(Report, SaysHowManyOfTheFramesAreSolved) {
  ASSERT_EQ(beam({"new", at("p.beam").string(), "--capture", SampleHouse::capture().string()}).code, 0);
  ASSERT_EQ(beam({"run", at("p.beam").string(), "--until", "capture"}).code, 0);
  ASSERT_EQ(beam(Words{"run", at("p.beam").string(), "--until", "surface"} + tiny()).code, 0);
  const Said said = beam({"report", at("p.beam").string(), "--out", at("report.html").string()});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("the report of 2 frames, 1 solved"));
}

TEST_F(Report, ScoresOfAnEvaluationFitALine) {
  const std::string capture = SampleHouse::capture().string(), project = at("p.beam").string();
  ASSERT_EQ(beam(Words{"process", capture, "--out", project} + tinyTake()).code, 0);
  const Said said = beam({"evaluate", project, "--ground-truth", capture});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("gaussian_base_color"));
  std::istringstream lines(said.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << line;
}

TEST_F(Report, AHeldOutPhotographChangesTheScoreAndNothingElse) {
  fs::copy(SampleHouse::capture(), at("capture"), fs::copy_options::recursive);
  ASSERT_EQ(process(at("capture")).code, 0);
  const fs::path held_out = at("capture") / "images/cam02";
  fs::copy_file(held_out / "000001.png", held_out / "000000.png", fs::copy_options::overwrite_existing);
  const Said said = process(at("capture"), {"--verbose"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("frame 000000 surface.refine: reused"));
  EXPECT_THAT(said.err, HasSubstr("surface.score, frame 000000 done"));
  EXPECT_THAT(said.err, HasSubstr("frame 000000 surface.mesh: reused"));
  EXPECT_THAT(said.err, HasSubstr("frame 000001 surface.score: reused"));
}

TEST_F(Report, EvaluateScoresAHeldOutCameraThatDropsTheFirstFrame) {
  fs::copy(SampleHouse::capture(), at("capture"), fs::copy_options::recursive);
  fs::remove(at("capture") / "images/cam02/000000.png");
  ASSERT_EQ(process(at("capture")).code, 0);
  const Said said = beam({"evaluate", at("p.beam").string(), "--json-file", at("scores.json").string()});
  ASSERT_EQ(said.code, 0) << said.err;
  const std::string json = textOf(at("scores.json"));
  EXPECT_THAT(json, HasSubstr("\"pictures\": 1.0"));
  EXPECT_THAT(json, HasSubstr("\"over_time\""));
  EXPECT_THAT(json, HasSubstr("\"000001\""));
  EXPECT_THAT(json, HasSubstr("\"cam02\""));
}

TEST_F(Report, ScoresAreToldThoughTheyCannotBeKept) {
  ASSERT_EQ(process(SampleHouse::capture()).code, 0);
  fs::create_directory(at("p.beam") / "evaluation.json");
  std::ofstream(at("p.beam") / "evaluation.json" / "in the way") << "";
  const Said said = beam({"evaluate", at("p.beam").string()});
  EXPECT_EQ(said.code, 74) << said.err;
  EXPECT_THAT(said.out, HasSubstr("psnr"));
  EXPECT_THAT(said.err, HasSubstr("evaluation.json"));
}

}  // namespace
}  // namespace beam::testing
