// SPDX-License-Identifier: Apache-2.0
// `beam render` as it is typed: layers of one file, and a render that goes on where it was stopped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/image_file.h"
#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

class Render : public ::testing::Test {
 protected:
  Words command(const char* out, const Words& more) const {
    return Words{"render",        SolvedHouse::project().string(),
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
