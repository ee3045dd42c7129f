// SPDX-License-Identifier: Apache-2.0
// `beam render` as it is typed: layers of one file, and a render that goes on where it was stopped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/io/image_file.h"
#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

constexpr const char* kAo = "relight.environment_shadows=ao";

class Render : public ::testing::Test {
 protected:
  Words command(const char* out, const Words& more) const {
    return command(SolvedHouse::project(), out, more);
  }
  Words command(const fs::path& project, const char* out, const Words& more) const {
    return Words{"render",        project.string(),
                 "--out",         at(out).string(),
                 "--channels",    "rgb,relight,depth",
                 "--environment", (SampleHouse::capture() / "environment.exr").string(),
                 "--cameras",     "all"} +
           more;
  }
  Said beam(const Words& words) const { return Running(folder_.path(), words).wait(); }
  fs::path at(const char* name) const { return folder_.path() / name; }

  TempDir folder_;
};

TEST_F(Render, WritesTheLayersOfACameraAndFrameIntoOneFile) {
  const Said said = beam(command("out", {"--layers"}));
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(exrChannels(at("out/layers/cam00/000000.exr")),
              IsSupersetOf({"R", "G", "B", "A", "relight_environment.R", "depth.Z"}));
  EXPECT_FALSE(fs::exists(at("out/rgb")));
}

TEST_F(Render, RefusesAPanoramaThatNoChannelIsLitBy) {
  const Said said = beam(command("out", {"--channels", "rgb,depth"}));
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, AllOf(HasSubstr("--environment"), HasSubstr("rgb, depth"), HasSubstr("relight")));
  EXPECT_FALSE(fs::exists(at("out")));
}

TEST_F(Render, LetsLightFallAsItIsToldForThesePictures) {
  const Said usual = beam(command("usual", {})), ao = beam(command("ao", {"--set", kAo}));
  ASSERT_EQ(usual.code, 0) << usual.err;
  ASSERT_EQ(ao.code, 0) << ao.err;
  EXPECT_THAT(usual.err, Not(HasSubstr("visibility")));
  const auto a = filesIn(at("usual")), b = filesIn(at("ao"));
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, bytes] : a) EXPECT_EQ(bytes != b.at(name), name.starts_with("relight_")) << name;
  const Said other = beam(command("x", {"--set", "surface.iterations=200"}));
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("beam run --set takes it"));
  EXPECT_FALSE(fs::exists(at("x")));
}

TEST_F(Render, MixesNoWaysOfLightInOneFolder) {
  ASSERT_EQ(beam(command("mix", {"--cameras", "cam00"})).code, 0);
  const Words other{"--cameras", "cam01", "--set", kAo};
  const Said said = beam(command("mix", other));
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, AllOf(HasSubstr("lit by the renderer cpu"), HasSubstr("ambient occlusion alone")));
  EXPECT_FALSE(fs::exists(at("mix/relight_environment/cam01")));
  EXPECT_EQ(beam(command("mix", other + Words{"--force"})).code, 0);
}

TEST_F(Render, AWayOfLightThatAProjectKeepsComputesNothing) {
  const fs::path project = at("kept.beam");
  fs::copy(SolvedHouse::project(), project, fs::copy_options::recursive);
  const Said run = beam({"run", project.string(), "--frames", "0", "--set", kAo, "--dry-run"});
  EXPECT_THAT(run.out, HasSubstr("nothing to compute"));
  ASSERT_EQ(beam({"run", project.string(), "--frames", "0", "--set", kAo}).code, 0);
  ASSERT_EQ(beam(command(project, "kept", {})).code, 0);
  ASSERT_EQ(beam(command("told", {"--set", kAo})).code, 0);
  EXPECT_TRUE(filesIn(at("kept")) == filesIn(at("told")));
}

TEST_F(Render, FollowsLightPathByPath) {
  const Words reference{"--renderer", "reference", "--spp", "4", "--cameras", "cam00"};
  const Said said = beam(command("out", reference + Words{"--channels", "relight,direct,indirect,variance"}));
  ASSERT_EQ(said.code, 0) << said.err;
  const Planes direct = readExr(at("out/direct/cam00/000000.exr"), {"R", "G", "B"}),
               indirect = readExr(at("out/indirect/cam00/000000.exr"), {"R", "G", "B"});
  const auto sum = [](const Planes& p) { return std::accumulate(p.values.begin(), p.values.end(), 0.0); };
  EXPECT_GT(sum(direct), 10);
  EXPECT_GT(sum(indirect), 0);
  EXPECT_LT(sum(indirect), sum(direct));
  EXPECT_GT(sum(readExr(at("out/variance/cam00/000000.exr"), {"Y"})), 0);
  EXPECT_TRUE(fs::exists(at("out/relight_environment/cam00/000000.png")));
  const Words lit{"--channels", "relight", "--skip-existing"};
  EXPECT_THAT(beam(command("out", reference + lit)).out, HasSubstr("nothing to draw"));
  const Said more = beam(command("out", reference + lit + Words{"--no-denoise"}));
  EXPECT_THAT(more.out, HasSubstr("wrote relight")) << more.err;
}

TEST_F(Render, MakesPicturesOfAnotherSize) {
  const Said said = beam(command("out", {"--size", "80x40", "--cameras", "cam00"}));
  ASSERT_EQ(said.code, 0) << said.err;
  const Planes depth = readExr(at("out/depth/cam00/000000.exr"), {"Y"});
  EXPECT_EQ(ivec2(depth.width, depth.height), ivec2(80, 40));
  EXPECT_TRUE(std::any_of(depth.values.begin(), depth.values.end(), [](float z) { return z > 0; }));
  for (const char* none : {"80", "80x", "8x8", "80x40x3", "axb"})
    EXPECT_EQ(beam(command("none", {"--size", none})).code, 2) << none;
}

TEST_F(Render, RefusesOfARendererWhatIsOfAnotherOne) {
  const auto refusal = [&](const Words& more) {
    const Said said = beam(command("none", more));
    EXPECT_EQ(said.code, 2) << said.err;
    return said.err;
  };
  EXPECT_THAT(refusal({"--channels", "direct"}), HasSubstr("the renderer cpu does not draw direct"));
  EXPECT_THAT(refusal({"--spp", "8"}), HasSubstr("--renderer reference alone"));
  EXPECT_THAT(refusal({"--renderer", "reference", "--spp", "0"}), HasSubstr("--spp"));
  EXPECT_THAT(refusal({"--renderer", "refrence"}), HasSubstr("did you mean \"reference\""));
  EXPECT_FALSE(fs::exists(at("none")));
}

TEST_F(Render, SaysWhereNoVisibilityWasBaked) {
  const fs::path project = at("bare.beam");
  fs::copy(SolvedHouse::project(), project, fs::copy_options::recursive);
  for (const auto& result : fs::directory_iterator(project / "results"))
    if (fs::exists(result.path() / "visibility.ply")) fs::remove_all(result.path());
  const Said said = beam(command(project, "bare", {"--layers"}));
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, AllOf(HasSubstr("000000"), HasSubstr("no visibility was baked")));
  ASSERT_EQ(beam(command("ao", {"--layers", "--set", kAo})).code, 0);
  const auto lit = [&](const char* out) {
    return readExr(at(out) / "layers/cam00/000000.exr", {"relight_environment.G"}).values;
  };
  EXPECT_EQ(lit("bare"), lit("ao"));
}

TEST_F(Render, LeavesWhatIsThereAndSaysSo) {
  ASSERT_EQ(beam(command("out", {})).code, 0);
  const auto before = filesIn(at("out"));
  EXPECT_THAT(beam(command("out", {"--skip-existing"})).out, HasSubstr("nothing to draw"));
  fs::remove(at("out/depth/cam00/000000.exr"));
  const Said rest = beam(command("out", {"--skip-existing"}));
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_THAT(rest.out, HasSubstr("files were there already"));
  EXPECT_EQ(filesIn(at("out")), before);
}

TEST_F(Render, ThatWasStoppedGoesOnAndPromisesNoMore) {
  ASSERT_EQ(beam(command("whole", {})).code, 0);
  const auto whole = filesIn(at("whole"));
  const Running run(folder_.path(), command("cut", {}));
  while (!run.ended() && (!fs::exists(at("cut")) || filesIn(at("cut")).empty()))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  run.signal(SIGTERM);
  const Said stopped = run.wait();
  // It may have been done before the signal came.
  if (stopped.code != 0) {
    EXPECT_EQ(stopped.code, 75) << stopped.err;
    EXPECT_THAT(stopped.err, HasSubstr("interrupted; the same command with --skip-existing goes on"));
  }
  const Said rest = beam(command("cut", {"--skip-existing"}));
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(filesIn(at("cut")), whole);
}

}  // namespace
}  // namespace beam::testing
