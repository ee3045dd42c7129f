// SPDX-License-Identifier: Apache-2.0
// The main job from end to end on the sample capture: process, reuse, resume, export.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class Process : public ::testing::Test {
 protected:
  TempDir folder_;
  fs::path at(const char* name) const { return folder_.path() / name; }
  Said beam(const Words& words) const { return Running(folder_.path(), words).wait(); }
  Words process(const fs::path& capture, const char* project) const {
    return Words{"process", capture.string(), "--out", at(project).string()} + tiny();
  }
  // What `beam export` writes of a project.
  std::map<std::string, std::string> exported(const char* project) const {
    fs::remove_all(at("exported"));
    const Said said =
        beam({"export", at(project).string(), "--format", "ply", "--out", at("exported").string()});
    EXPECT_EQ(said.code, 0) << said.err;
    return filesIn(at("exported"));
  }
};

TEST_F(Process, GoesFromPicturesToMaterialsAndComputesNothingTwice) {
  const Said first = beam(process(SampleHouse::capture(), "p.beam"));
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr("materials.fit: done"));
  const auto products = exported("p.beam");
  ASSERT_FALSE(products.empty());
  const Said second = beam(process(SampleHouse::capture(), "p.beam"));
  EXPECT_EQ(second.code, 0);
  EXPECT_THAT(second.err, HasSubstr("nothing to compute"));
  EXPECT_THAT(second.err, Not(HasSubstr("done in")));
  EXPECT_THAT(beam({"status", at("p.beam").string()}).out, HasSubstr("materials.fit"));
}

TEST_F(Process, GivesTheSameBytesForAnyThreadsAndInstructionSet) {
  std::map<std::string, std::string> reference;
  for (const Words& way : {Words{"--threads", "1"}, Words{"--threads", "2"}, Words{"--threads", "3"},
                           Words{"--simd", "scalar"}}) {
    fs::remove_all(at("p.beam"));
    ASSERT_EQ(beam(process(SampleHouse::capture(), "p.beam") + way).code, 0);
    const auto bytes = exported("p.beam");
    if (reference.empty()) reference = bytes;
    EXPECT_TRUE(bytes == reference) << way[0] << " " << way[1];
  }
}

TEST_F(Process, DoesNotReadTheGroundTruth) {
  fs::copy(SampleHouse::capture(), at("capture"), fs::copy_options::recursive);
  ASSERT_TRUE(fs::exists(at("capture") / "gt"));
  fs::remove_all(at("capture") / "gt");
  ASSERT_EQ(beam(process(SampleHouse::capture(), "with.beam")).code, 0);
  ASSERT_EQ(beam(process(at("capture"), "without.beam")).code, 0);
  EXPECT_TRUE(exported("with.beam") == exported("without.beam"));
}

TEST_F(Process, OfACaptureThatMovedSaysHowItIsFoundAgain) {
  fs::copy(SampleHouse::capture(), at("capture"), fs::copy_options::recursive);
  ASSERT_EQ(beam(process(at("capture"), "p.beam")).code, 0);
  const auto products = exported("p.beam");
  fs::rename(at("capture"), at("moved"));
  const std::string project = at("p.beam").string();
  const std::string advice = "beam process FOLDER --out \"" + project + "\" --until capture";
  for (const Words& words : {Words{"render", project, "--out", at("pictures").string()},
                             Words{"export", project, "--out", at("splats").string()},
                             Words{"report", project, "--out", at("page.html").string()}}) {
    const Said said = beam(words);
    EXPECT_EQ(said.code, 65) << words[0];
    EXPECT_THAT(said.err, HasSubstr(advice)) << words[0];
  }
  ASSERT_EQ(beam({"process", at("moved").string(), "--out", project, "--until", "capture"}).code, 0);
  EXPECT_TRUE(exported("p.beam") == products);
}

TEST_F(Process, StopsAfterSurfaceWithoutAPanoramaAndSaysWhatItNeeds) {
  fs::copy(SampleHouse::capture(), at("capture"), fs::copy_options::recursive);
  fs::remove(at("capture") / "environment.exr");
  const Said said = beam(process(at("capture"), "p.beam"));
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("--environment"));
  EXPECT_THAT(said.err, HasSubstr("surface.mesh: done"));
  EXPECT_THAT(said.err, Not(HasSubstr("materials")));
  // Given one, the same command does the rest and only the rest.
  const Said rest =
      beam(process(at("capture"), "p.beam") +
           Words{"--environment", (SampleHouse::capture() / "environment.exr").string(), "--verbose"});
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_THAT(rest.err, HasSubstr("surface.mesh: reused"));
  EXPECT_THAT(rest.err, HasSubstr("materials.fit, frame 000000 done"));
}

TEST_F(Process, KilledAtAnyMomentItGoesOnAndEndsWithTheSameBytes) {
  const CalmRun calm =
      runCalmly(folder_.path(), process(SampleHouse::capture(), "calm.beam"), at("calm.beam"));
  const Words command = process(SampleHouse::capture(), "p.beam");
  ASSERT_EQ(cutShort(folder_.path(), command, at("p.beam"), calm, 5), 5);
  const Said said = beam(command);
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("reused\n")) << "the last kill found something published";
  EXPECT_THAT(said.err, HasSubstr(": done")) << "but not all of it";
  EXPECT_TRUE(exported("p.beam") == exported("calm.beam"));
}

TEST_F(Process, AStopSignalEndsItWith75AndTheSameCommandGoesOn) {
  const Words command = Words{"process",  SampleHouse::capture().string(),
                              "--out",    at("p.beam").string(),
                              "--until",  "surface",
                              "--frames", "0",
                              "--set",    "surface.iterations=100000"};
  const Running run(folder_.path(), command);
  while (!fs::exists(at("p.beam") / "leases")) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  run.signal(SIGTERM);
  const Said said = run.wait();
  EXPECT_EQ(said.code, 75) << said.err;
  EXPECT_THAT(said.err, HasSubstr("interrupted"));
  for (const auto& entry : fs::directory_iterator(at("p.beam") / "results")) {
    EXPECT_NE(entry.path().filename().string().front(), '.');
  }
  const Said rest = beam({"run", at("p.beam").string(), "--until", "surface", "--frames", "0", "--set",
                          "surface.iterations=20", "--set", "surface.cap=400"});
  EXPECT_EQ(rest.code, 0) << rest.err;
}

}  // namespace
}  // namespace beam::testing
