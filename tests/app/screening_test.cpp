// SPDX-License-Identifier: Apache-2.0
// A run with a camera that is black in one frame goes on without it there, and says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kLeftOut = "left out of the fit: camera cam01 in frame 000001: is black";

// Two frames as far as Surface, made once; settings that take a moment.
class LeavingOut : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempDir;
    const Said said = beam({"sample", at("capture"), "--frames", "2", "--cameras", "5", "--size", "48x64",
                            "--samples", "4", "--defect", "black:cam01"});
    ASSERT_EQ(said.code, 0) << said.err;
    run_ = process("p.beam");
    ASSERT_EQ(run_.code, 0) << run_.err;
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static std::string at(const char* name) { return (folder_->path() / name).string(); }
  static Said beam(const Words& words) { return Running(folder_->path(), words).wait(); }
  static Said process(const char* project, const Words& more = {}) {
    return beam(
        Words{"process", at("capture"), "--out", at(project), "--hold-out", "cam02", "--until", "surface"} +
        tinyTake() + more);
  }
  // The Gaussians of a frame as they are exported.
  static std::string cloud(const char* project, const char* frame) {
    const std::string out = at((std::string(project) + frame).c_str());
    beam({"export", at(project), "--format", "ply", "--frames", frame, "--out", out});
    return textOf(fs::path(out) / ("frame." + std::string(frame) + ".ply"));
  }

  static inline TempDir* folder_ = nullptr;
  static inline Said run_;
};

TEST_F(LeavingOut, IsSaidByTheRunTheStatusAndTheReport) {
  EXPECT_THAT(run_.err, HasSubstr("frame 000001: camera cam01 is black"));
  EXPECT_THAT(run_.err, HasSubstr("from 3 of 4 cameras"));
  EXPECT_THAT(run_.err, Not(HasSubstr("frame 000000: camera")));
  EXPECT_THAT(beam({"status", at("p.beam")}).out, HasSubstr(kLeftOut));
  EXPECT_THAT(beam({"status", at("p.beam"), "--json"}).out, HasSubstr("\"left_out\""));
  const Said report = beam({"report", at("p.beam"), "--out", at("report.html")});
  ASSERT_EQ(report.code, 0) << report.err;
  EXPECT_THAT(report.err, HasSubstr(kLeftOut));
  const std::string page = textOf(at("report.html"));
  EXPECT_THAT(page, HasSubstr("camera cam01 in frame 000001: is black"));
  EXPECT_THAT(page, HasSubstr("from at least 3 of 4 views"));
  EXPECT_THAT(page, AnyOf(HasSubstr("The loss shows in the held-out views"),
                          HasSubstr("The held-out views show no loss")));
  EXPECT_THAT(page, HasSubstr("training, left out of 1"));
  EXPECT_THAT(page, HasSubstr("cam01 is black in 1 frame"));  // the evidence of the scores stays
}

TEST_F(LeavingOut, ChangesOnlyTheFramesWithABadCamera) {
  const Said off = process("off.beam", {"--set", "capture.screen.enabled=false"});
  ASSERT_EQ(off.code, 0);
  EXPECT_THAT(off.err, Not(HasSubstr("is black")));
  EXPECT_THAT(beam({"status", at("off.beam")}).out, Not(HasSubstr("left out of the fit")));
  ASSERT_FALSE(cloud("p.beam", "000000").empty());
  EXPECT_TRUE(cloud("p.beam", "000000") == cloud("off.beam", "000000"));
  EXPECT_FALSE(cloud("p.beam", "000001") == cloud("off.beam", "000001"));
}

}  // namespace
}  // namespace beam::testing
