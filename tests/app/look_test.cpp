// SPDX-License-Identifier: Apache-2.0
// `beam render --look` as it is typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numeric>

#include "core/io/image_file.h"
#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kFormat = R"("format": {"name": "beam-look", "major": 1, "minor": 0})";

class RenderLook : public ::testing::Test {
 protected:
  fs::path write(const char* name, const std::string& members) const {
    std::ofstream(at(name)) << "{" << kFormat << ", " << members << "}";
    return at(name);
  }
  Said draw(const fs::path& look, const Words& more = {}) const {
    return Running(folder_.path(), Words{"render", SolvedHouse::project().string(), "--out",
                                         at("out").string(), "--cameras", "cam00", "--look", look.string()} +
                                       more)
        .wait();
  }
  fs::path at(const char* name) const { return folder_.path() / name; }
  double sumOf(const char* file) const {
    const Planes p = readExr(at(file), {"R", "G", "B"});
    return std::accumulate(p.values.begin(), p.values.end(), 0.0);
  }

  TempDir folder_;
};

constexpr const char* kSun =
    R"("view_transform": "raw", "environment": {"enabled": false},
       "lights": [{"id": "sun", "kind": "directional", "azimuth_deg": 220, "elevation_deg": 40}])";

TEST_F(RenderLook, DrawsLampsAloneUnderTheNameOfTheFile) {
  const Said said = draw(write("sun.json", kSun));
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("look_sun"));
  EXPECT_GT(sumOf("out/look_sun/cam00/000000.exr"), 10);
  EXPECT_EQ(exrChannels(at("out/look_sun/cam00/000000.exr")), (std::vector<std::string>{"A", "B", "G", "R"}));
}

TEST_F(RenderLook, InRealTimeIsNearTheReference) {
  const fs::path look = write("sun.json", kSun);
  ASSERT_EQ(draw(look).code, 0);
  const double fast = sumOf("out/look_sun/cam00/000000.exr");
  const Said said = draw(look, {"--renderer", "reference", "--spp", "16", "--no-denoise", "--force"});
  ASSERT_EQ(said.code, 0) << said.err;
  // The reference has light that bounces as well.
  const double slow = sumOf("out/look_sun/cam00/000000.exr");
  EXPECT_GT(slow, fast);
  EXPECT_LT(slow, 1.5 * fast);
}

TEST_F(RenderLook, IsAsItIsAtTheTimeOfTheFrame) {
  ASSERT_EQ(draw(write("whole.json", kSun)).code, 0);
  const std::string driven =
      std::string(kSun) +
      R"(, "curves": {"lights.sun.intensity": {"keys": [{"time_s": 0, "value": 1.5}, {"time_s": 1, "value": 9}]}})";
  const Said said = draw(write("half.json", driven));
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_NEAR(sumOf("out/look_half/cam00/000000.exr") / sumOf("out/look_whole/cam00/000000.exr"), 0.5, 1e-3);
}

TEST_F(RenderLook, HasAPictureThatPeopleLookAt) {
  const Said said = draw(write("a.json", R"("name": "stage light", "background": {"kind": "color"})"));
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_EQ(readImageSize(at("out/look_stage light/cam00/000000.png")).has_alpha, false);
}

TEST_F(RenderLook, RefusesWhatItCannotDraw) {
  const auto refusal = [&](const fs::path& look, int code, const Words& more = {}) {
    const Said said = draw(look, more);
    EXPECT_EQ(said.code, code) << said.err;
    EXPECT_FALSE(fs::exists(at("out"))) << said.err;
    return said.err;
  };
  EXPECT_THAT(refusal("nowhere", 2), AllOf(HasSubstr("--look"), HasSubstr("nowhere")));
  const fs::path sun = write("sun.json", kSun);
  EXPECT_THAT(refusal(sun, 2, {"--channels", "rgb"}), HasSubstr("--channels does not go with --look"));
  EXPECT_THAT(refusal(write("dark.json", R"("environment": {"enabled": false})"), 2),
              HasSubstr("nothing shines"));
  EXPECT_THAT(refusal(write("agx.json", R"("view_transform": "agx")"), 2), HasSubstr("standard, neutral"));
  EXPECT_THAT(refusal(write("bad.json", R"("exposure_stops": "much")"), 65), HasSubstr("exposure_stops"));
}

TEST_F(RenderLook, OfALaterVersionIsDrawnAsFarAsItIsKnown) {
  const Said said = draw(write("later.json", R"("lights": [{"id": "tube", "kind": "tube"}], "glow": 3)"));
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, AllOf(HasSubstr("tube"), HasSubstr("\"glow\" is nothing that this program knows")));
}

TEST_F(RenderLook, FilmsACameraThatMoves) {
  const fs::path look = write("a.json", R"("name": "stage")");
  const Said said =
      draw(look, {"--camera-path", "turntable", "--duration", "0.2", "--rate", "10", "--size", "40x60"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("wrote 2 pictures of look_stage"));
  const ImageSize size = readImageSize(at("out/look_stage/turntable/000001.png"));
  EXPECT_EQ(size.width, 40);
  EXPECT_EQ(size.height, 60);
  EXPECT_EQ(draw(look, {"--camera-path", "nowhere"}).code, 2);
  EXPECT_THAT(draw(look, {"--duration", "3"}).err, HasSubstr("add --camera-path"));
}

}  // namespace
}  // namespace beam::testing
