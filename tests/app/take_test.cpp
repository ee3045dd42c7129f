// SPDX-License-Identifier: Apache-2.0
// Frames that build on each other, as the program runs them: the Gaussians keep their order, a kill and the
// number of threads change no byte, segments run apart and join, a restart is a new beginning.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/file.h"
#include "core/io/splat_ply.h"
#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class TakeRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempDir;
    const Said said = Running(folder_->path(), {"sample", at("capture"), "--frames", "4", "--cameras", "5",
                                                "--size", "48x64", "--samples", "2"})
                          .wait();
    ASSERT_EQ(said.code, 0) << said.err;
    calm_ = runCalmly(at(""), command("calm.beam"), at("calm.beam"));
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string at(const std::string& name) { return (folder_->path() / name).string(); }
  static Said beam(const Words& words) { return Running(folder_->path(), words).wait(); }
  static Words command(const std::string& project, const Words& more = {}) {
    return Words{"process", at("capture"), "--out", at(project)} + tinyTake() + more;
  }
  static Said process(const std::string& project, const Words& more = {}) {
    return beam(command(project, more));
  }
  static std::map<std::string, std::string> exported(const std::string& project) {
    const std::string out = at(project + ".ply");
    const Said said = beam({"export", at(project), "--format", "ply", "--out", out});
    EXPECT_EQ(said.code, 0) << said.err;
    return filesIn(out);
  }
  static GaussianCloud cloud(const std::string& project, const std::string& frame) {
    return readSplatPly(fs::path(at(project + ".ply")) / ("frame." + frame + ".ply")).cloud;
  }
  static inline CalmRun calm_;

 private:
  static inline TempDir* folder_ = nullptr;
};

TEST_F(TakeRun, KeepsTheGaussiansThroughTheTake) {
  ASSERT_EQ(exported("calm.beam").size(), 4u);
  const GaussianCloud first = cloud("calm.beam", "000000"), last = cloud("calm.beam", "000003");
  EXPECT_EQ(first.size(), last.size());
  EXPECT_NE(first.position_m, last.position_m);
}

TEST_F(TakeRun, KilledAtAnyMomentOrWithOneThreadItEndsWithTheSameBytes) {
  const Words one = command("killed.beam", {"--threads", "1"});
  ASSERT_EQ(cutShort(at(""), one, at("killed.beam"), calm_, 5), 5);
  const Said said = beam(one);
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("reused\n")) << "the last kill found something published";
  EXPECT_THAT(said.err, HasSubstr(": done")) << "but not all of it";
  EXPECT_TRUE(exported("killed.beam") == exported("calm.beam"));
}

TEST_F(TakeRun, SegmentsOfTwoProcessesJoin) {
  fs::create_directories(at("a"));
  fs::create_directories(at("b"));
  ASSERT_EQ(beam({"new", at("two.beam"), "--capture", at("capture")}).code, 0);
  const Words run = Words{"run", at("two.beam"), "--until", "materials"} + tinyTake() + Words{"--frames"};
  const Running later(at("a"), run + Words{"2-3"}), earlier(at("b"), run + Words{"0-1"});
  EXPECT_EQ(later.wait().code, 0);
  EXPECT_EQ(earlier.wait().code, 0);
  const Said joined = beam({"run", at("two.beam"), "--until", "materials"});
  ASSERT_EQ(joined.code, 0) << joined.err;
  EXPECT_THAT(joined.err, Not(HasSubstr(": done")));
  EXPECT_EQ(exported("two.beam").size(), 4u);
  // The lead of the second segment reaches back to the first frame: it is the take that one run makes.
  exported("calm.beam");
  for (const char* frame : {"000001", "000003"})
    EXPECT_EQ(cloud("two.beam", frame).position_m, cloud("calm.beam", frame).position_m);
}

TEST_F(TakeRun, StartsAnewWhereTheResidualSaysSo) {
  const Said said = process("anew.beam", {"--set", "track.restart_ratio=0.001"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("start anew"));
  EXPECT_EQ(exported("anew.beam").size(), 4u);
  int restarts = 0;
  for (const auto& result : fs::directory_iterator(fs::path(at("anew.beam")) / "results")) {
    const fs::path note = result.path() / "track.json";
    if (!fs::exists(note) || readTextFile(note).find("\"restarted\": true") == std::string::npos) continue;
    ++restarts;
    EXPECT_FALSE(fs::exists(result.path() / "before.ply")) << "new joints have no past";
  }
  EXPECT_GT(restarts, 0);
}

TEST_F(TakeRun, ALoneFrameIsFittedAlone) {
  ASSERT_EQ(process("lone.beam", {"--frames", "2"}).code, 0);
  EXPECT_THAT(beam({"status", at("lone.beam")}).out, HasSubstr("not needed"));
  const Said second = process("pair.beam", {"--frames", "2-3", "--set", "track.overlap=0"});
  ASSERT_EQ(second.code, 0) << second.err;
  exported("lone.beam");
  exported("pair.beam");
  EXPECT_EQ(cloud("lone.beam", "000002").position_m, cloud("pair.beam", "000002").position_m);
}

}  // namespace
}  // namespace beam::testing
