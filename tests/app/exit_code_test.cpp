// SPDX-License-Identifier: Apache-2.0
// What `beam` says and returns when something is wrong; scripts rely on the codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

class ExitCode : public ::testing::Test {
 protected:
  TempDir folder_;
  fs::path at(const char* name) const { return folder_.path() / name; }
  Said beam(const Words& words) const { return Running(folder_.path(), words).wait(); }

  // A writable copy of the sample capture.
  fs::path copyOfSample() const {
    fs::copy(SampleHouse::capture(), at("capture"), fs::copy_options::recursive);
    return at("capture");
  }
  Said processUntilCapture(const fs::path& capture) const {
    return beam({"process", capture.string(), "--out", at("p.beam").string(), "--until", "capture"});
  }
  void expectUsage(const Words& words, const std::string& hint) const {
    const Said said = beam(words);
    EXPECT_EQ(said.code, 2) << said.err;
    EXPECT_THAT(said.err, HasSubstr(hint));
    EXPECT_THAT(said.err, ::testing::StartsWith("error: "));
  }
  // Of a training camera, frame 000000.
  fs::path firstPicture(const fs::path& capture) const {
    for (const auto& entry : fs::recursive_directory_iterator(capture / "images")) {
      const bool train = entry.path().parent_path().filename().string().starts_with("cam");
      if (train && entry.path().stem() == "000000") return entry.path();
    }
    return {};
  }
};

TEST_F(ExitCode, HelpAndVersionAreNoErrors) {
  EXPECT_EQ(beam({"--help"}).code, 0);
  EXPECT_EQ(beam({"process", "--help"}).code, 0);
  EXPECT_THAT(beam({"--version"}).out, HasSubstr("beam 0."));
  EXPECT_THAT(beam({"--version", "--verbose"}).out, HasSubstr("device:"));
  EXPECT_THAT(beam({"stages"}).out, HasSubstr("surface.iterations"));
  EXPECT_THAT(beam({"stages", "--json"}).out, HasSubstr("\"surface.refine.normal_weight\""));
}

TEST_F(ExitCode, WrongWordsAreUsageErrorsThatNameTheNearest) {
  const std::string capture = SampleHouse::capture().string(), out = at("p.beam").string();
  const Words process = {"process", capture, "--out", out};
  expectUsage(process + Words{"--set", "surface.iteration=5"}, "surface.iterations");
  expectUsage(process + Words{"--set", "surface.iterations=many"}, "surface.iterations");
  expectUsage(process + Words{"--set", "surface.iterations=-1"}, "surface.iterations");
  expectUsage(process + Words{"--set", "surface.iterations"}, "key=value");
  expectUsage(process + Words{"--preset", "drift"}, "draft");
  expectUsage(process + Words{"--until", "surfaces"}, "surface");
  expectUsage(process + Words{"--frames", "99"}, "99");
  expectUsage(process + Words{"--every", "0"}, "every");
  expectUsage(process + Words{"--every", "two"}, "--every");
  expectUsage(process + Words{"--simd", "mmx"}, "mmx");
  expectUsage({"process", capture}, "--out");
  expectUsage({"frobnicate"}, "frobnicate");
}

TEST_F(ExitCode, WrongWordsLeaveNoProjectBehind) {
  beam({"process", SampleHouse::capture().string(), "--out", at("p.beam").string(), "--set",
        "surface.iteration=5"});
  EXPECT_FALSE(fs::exists(at("p.beam")));
}

TEST_F(ExitCode, WhatIsNoCaptureIsBadInputAndLeavesNoProjectBehind) {
  fs::create_directories(at("empty"));
  for (const char* name : {"empty", "missing"}) {
    const Said said = processUntilCapture(at(name));
    EXPECT_EQ(said.code, 65) << said.err;
    EXPECT_THAT(said.err, HasSubstr(name));
    EXPECT_FALSE(fs::exists(at("p.beam")));
  }
  EXPECT_EQ(beam({"status", at("empty").string()}).code, 65);
  EXPECT_EQ(beam({"run", at("missing").string()}).code, 65);
}

TEST_F(ExitCode, ANumberThatIsNoneInTheCalibrationIsBadInput) {
  const fs::path capture = copyOfSample();
  std::string text = textOf(capture / "dataset.json");
  const std::size_t at_fx = text.find("\"fx\"");
  ASSERT_NE(at_fx, std::string::npos);
  const std::size_t from = text.find(':', at_fx) + 1, to = text.find_first_of(",}\n", from);
  std::ofstream(capture / "dataset.json") << text.replace(from, to - from, " NaN");
  const Said said = processUntilCapture(capture);
  EXPECT_EQ(said.code, 65) << said.err;
  EXPECT_THAT(said.err, HasSubstr("dataset.json"));
}

TEST_F(ExitCode, ATornPictureIsLeftOutByName) {
  const fs::path capture = copyOfSample();
  const fs::path picture = firstPicture(capture);
  fs::resize_file(picture, fs::file_size(picture) / 2);
  const Said said =
      beam(Words{"process", capture.string(), "--out", at("p.beam").string(), "--until", "surface"} + tiny());
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("warning: "));
  EXPECT_THAT(said.err, HasSubstr(picture.filename().string()));
}

TEST_F(ExitCode, AMissingCameraFolderIsLeftOutByName) {
  const fs::path capture = copyOfSample();
  const fs::path camera = firstPicture(capture).parent_path();
  fs::remove_all(camera);
  const Said said =
      beam(Words{"process", capture.string(), "--out", at("p.beam").string(), "--until", "surface"} + tiny());
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr(camera.filename().string()));
}

TEST_F(ExitCode, AFrameWithoutPicturesFailsAloneWith10) {
  const fs::path capture = copyOfSample();
  for (const auto& entry : fs::recursive_directory_iterator(capture / "images")) {
    if (entry.is_regular_file() && entry.path().stem() == "000000") fs::resize_file(entry.path(), 20);
  }
  Words words =
      Words{"process", capture.string(), "--out", at("p.beam").string(), "--until", "surface"} + tiny();
  words.back() = "all";
  const Said said = beam(words);
  EXPECT_EQ(said.code, 10) << said.err;
  EXPECT_THAT(said.err, HasSubstr("000000"));
  EXPECT_THAT(said.err, HasSubstr("frame 000001 surface.mesh: done"));
  EXPECT_THAT(said.err, HasSubstr("1 of 2 frames failed (000000); the others are done"));
  EXPECT_THAT(said.err, Not(HasSubstr(": frame 000000: "))) << "a place is named once";
  EXPECT_THAT(beam({"status", at("p.beam").string()}).out, HasSubstr("failed"));
  words.back() = "0";
  EXPECT_THAT(beam(words).err, AllOf(HasSubstr("the frame failed (000000)"), Not(HasSubstr("the others"))));
}

TEST_F(ExitCode, AnEmptyPanoramaIsBadInput) {
  std::ofstream(at("light.exr")) << "";
  const Said said = beam({"process", SampleHouse::capture().string(), "--out", at("p.beam").string(),
                          "--environment", at("light.exr").string(), "--stage", "light"});
  EXPECT_EQ(said.code, 65) << said.err;
  EXPECT_THAT(said.err, HasSubstr("light.exr"));
}

TEST_F(ExitCode, AProjectOfAnotherCaptureIsNotTakenOver) {
  ASSERT_EQ(processUntilCapture(SampleHouse::capture()).code, 0);
  const fs::path other = copyOfSample();
  std::ofstream(other / "dataset.json", std::ios::app) << "\n";
  const Said said = processUntilCapture(other);
  EXPECT_EQ(said.code, 2) << said.err;
  EXPECT_THAT(said.err, HasSubstr("another capture"));
}

TEST_F(ExitCode, AReadOnlyProjectCanBeLookedAtButNotRun) {
  ASSERT_EQ(processUntilCapture(SampleHouse::capture()).code, 0);
  fs::permissions(at("p.beam"), fs::perms(0555));
  const Said looked = beam({"status", at("p.beam").string()});
  EXPECT_EQ(looked.code, 0) << looked.err;
  EXPECT_THAT(looked.out, HasSubstr("read-only"));
  const Said run = beam({"run", at("p.beam").string(), "--until", "surface"});
  EXPECT_EQ(run.code, 74) << run.err;
  EXPECT_THAT(run.err, HasSubstr("read-only"));
  EXPECT_EQ(beam({"run", at("p.beam").string(), "--until", "capture"}).code, 0);  // nothing to write
  fs::permissions(at("p.beam"), fs::perms(0755));
}

TEST_F(ExitCode, APlaceThatCannotBeWrittenIsAStorageError) {
  std::ofstream(at("taken")) << "a file";
  const std::string below = (at("taken") / "out").string();
  for (const Words& words : {Words{"sample", below},
                             Words{"new", below + ".beam", "--capture", SampleHouse::capture().string()}}) {
    const Said said = beam(words);
    EXPECT_EQ(said.code, 74) << said.err;
    EXPECT_THAT(said.err, HasSubstr("taken"));
  }
}

TEST_F(ExitCode, AFullDiskIsAStorageErrorAndCostsNothingThatWasFinished) {
  const Words words = Words{"process", SampleHouse::capture().string(), "--out", at("p.beam").string()} +
                      tiny() + Words{"--set", "surface.cap=2000"};
  const Said full = Running(folder_.path(), words, 100000).wait();
  EXPECT_EQ(full.code, 74) << full.err;
  EXPECT_THAT(full.err, HasSubstr("error: cannot write"));
  for (const auto& entry : fs::directory_iterator(at("p.beam") / "results")) {
    EXPECT_NE(entry.path().filename().string().front(), '.');
  }
  const Said rest = beam(words + Words{"--verbose"});
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_THAT(rest.err, HasSubstr("capture.import: reused"));
}

TEST_F(ExitCode, QuietLeavesOnlyWarningsAndErrors) {
  const Said said = beam({"process", SampleHouse::capture().string(), "--out", at("p.beam").string(),
                          "--until", "capture", "--quiet"});
  EXPECT_EQ(said.code, 0);
  EXPECT_EQ(said.err, "");
  EXPECT_THAT(beam({"run", at("p.beam").string(), "--quiet", "--frames", "77"}).err, HasSubstr("error: "));
}

}  // namespace
}  // namespace beam::testing
