// SPDX-License-Identifier: Apache-2.0
// Films of a look: which frame is seen when, where the camera is, what lies where; and scenes of several
// takes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/image_file.h"
#include "core/io/movie_file.h"
#include "core/io/scene_document_json.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/work/render_look.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_project.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr StandInSize kSmall{.cameras = 3, .frames = 3, .size_px = 48};

TEST(LookTake, PlaysToAndFroAtTheRateOfTheTake) {
  const auto seen = [](const std::vector<FrameIndex>& frames, int pictures) {
    std::vector<int> values;
    for (int i = 0; i < pictures; ++i) values.push_back(frameToAndFro(frames, 30, i / 30.0).value);
    return values;
  };
  EXPECT_THAT(seen({FrameIndex{2}, FrameIndex{3}, FrameIndex{4}}, 7), ElementsAre(2, 3, 4, 3, 2, 3, 4));
  EXPECT_THAT(seen({FrameIndex{7}}, 3), ElementsAre(7, 7, 7));
  EXPECT_THAT(seen({FrameIndex{0}, FrameIndex{3}}, 8), ElementsAre(0, 0, 0, 3, 0, 0, 0, 0))
      << "the last at or before";
  EXPECT_EQ(frameToAndFro({FrameIndex{0}, FrameIndex{1}, FrameIndex{2}}, 30, 1e6).value, 0)
      << "of 30,000,000";
}

// What is logged while it lives.
class Warnings {
 public:
  Warnings() : token_(addLogSink([this](const LogRecord& r) { texts.push_back(r.text); })) {}
  ~Warnings() { removeLogSink(token_); }
  std::vector<std::string> texts;

 private:
  int token_;
};

class LookFilm : public ::testing::Test {
 protected:
  static const Project& solved() {
    static const TempDir folder;
    static const Project project = solvedStandIn(folder.path(), kSmall);
    return project;
  }
  static Look sunny(const char* name) {
    Look look;
    look.name = name;
    look.lighting.environment.enabled = false;
    look.lighting.lights = {newLight("sun", "directional")};
    return look;
  }
  RenderLookRequest asked(const Look& look) const {
    return {.project = solved(),
            .look = {look, folder_.path(), {}},
            .cameras = "cam1,cam0",
            .out = folder_ / "out"};
  }
  RenderLookOutcome render(const RenderLookRequest& request) const {
    Progress progress;
    return renderLook(request, *newCpuSceneRenderer(*device_), progress);
  }
  Image<u8vec3> picture(const char* file) const { return readPhoto(folder_ / file); }

  TempDir folder_;
  std::unique_ptr<ComputeDevice> device_ = makeCpuDevice();
};

TEST_F(LookFilm, OfATurntableBeginsAtTheFirstCameraAndComesRound) {
  RenderLookRequest request = asked(sunny("key"));
  render(request);
  request.camera_path = "turntable";
  request.timing = {.duration_s = 0.25, .rate = 16};
  const RenderLookOutcome outcome = render(request);
  EXPECT_EQ(outcome.pictures, 4u);
  EXPECT_EQ(outcome.cameras, 0u);
  EXPECT_EQ(picture("out/look_key/turntable/000000.png").pixels,
            picture("out/look_key/cam1/000000.png").pixels);
  EXPECT_NE(picture("out/look_key/turntable/000002.png").pixels,
            picture("out/look_key/turntable/000000.png").pixels);
  EXPECT_FALSE(fs::exists(folder_ / "out/look_key/turntable/000004.png"));
  if (!canWriteMovies()) GTEST_SKIP() << "ffmpeg is not installed: no film was looked for";
  EXPECT_EQ(outcome.film, "look_key/turntable.mp4");
  EXPECT_GT(fs::file_size(folder_ / "out/look_key/turntable.mp4"), 500u);
  render(request);  // its own files are replaced
}

TEST_F(LookFilm, FollowsKeysOfCameraLampAndTake) {
  std::ofstream(folder_ / "fly.json")
      << R"({"format": {"name": "beam-camera-path", "major": 1, "minor": 0}, "keys": [
             {"time_s": 0, "position_m": {"x": 0, "y": 0, "z": 4}, "target_m": {"x": 0, "y": 0, "z": 0}},
             {"time_s": 0.2, "position_m": {"x": 2, "y": 0, "z": 4}, "target_m": {"x": 0, "y": 0, "z": 0}}]})";
  Look look = sunny("key");
  look.curves["lights.sun.intensity"] = {{{.time_s = 0, .value = 2}, {.time_s = 0.1, .value = 0}}};
  RenderLookRequest request = asked(look);
  request.camera_path = (folder_ / "fly.json").string();
  request.timing.rate = 10;
  request.size = ivec2(64, 32);
  EXPECT_EQ(render(request).pictures, 2u);
  const auto lit = picture("out/look_key/fly/000000.png"), dark = picture("out/look_key/fly/000001.png");
  EXPECT_EQ(ivec2(lit.width, lit.height), ivec2(64, 32));
  const auto brightest = [](const Image<u8vec3>& p) {
    int most = 0;
    for (const u8vec3& c : p.pixels) most = std::max({most, int(c.x), int(c.y), int(c.z)});
    return most;
  };
  EXPECT_GT(brightest(lit), 60);
  EXPECT_EQ(brightest(dark), 0);
}

TEST_F(LookFilm, HasThePathOfItsLookUnlessAnotherIsTyped) {
  Look look = sunny("key");
  look.camera_path.kind = "turntable";
  RenderLookRequest request = asked(look);
  request.timing = {.duration_s = 0.1, .rate = 10};
  EXPECT_EQ(render(request).pictures, 1u);
  request.timing = {};
  request.camera_path = "none";
  EXPECT_EQ(render(request).cameras, 2u);
}

TEST_F(LookFilm, RefusesWhatHasNoEndAndWhatIsNotThere) {
  RenderLookRequest request = asked(sunny("key"));
  const auto refusal = [&](const RenderLookRequest& r) {
    return messageOf(Error::Kind::Usage, [&] { render(r); });
  };
  request.timing.duration_s = 3;
  EXPECT_THAT(refusal(request), HasSubstr("add --camera-path"));
  request.camera_path = "turntable";
  request.timing = {.duration_s = 1e9, .rate = 30};
  EXPECT_THAT(refusal(request), HasSubstr("shorten --duration"));
  request.timing = {.duration_s = -1};
  EXPECT_THAT(refusal(request), HasSubstr("--duration"));
  request.timing = {.rate = 0};
  EXPECT_THAT(refusal(request), HasSubstr("--rate"));
  std::ofstream(folder_ / "still.json")
      << R"({"format": {"name": "beam-camera-path", "major": 1, "minor": 0}, "keys": [{"time_s": 0}]})";
  request.camera_path = (folder_ / "still.json").string();
  EXPECT_THAT(refusal(request), HasSubstr("--rate")) << "a lone key stands: its time is no fault";
  request.camera_path = "nowhere.json";
  EXPECT_THAT(refusal(request), HasSubstr("nowhere.json"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(LookFilm, OfRawIsPicturesAloneAndSaysSo) {
  Look look = sunny("key");
  look.view_transform = "raw";
  RenderLookRequest request = asked(look);
  request.camera_path = "turntable";
  request.timing = {.duration_s = 0.1, .rate = 10};
  const Warnings warnings;
  EXPECT_EQ(render(request).film, "");
  EXPECT_TRUE(fs::exists(folder_ / "out/look_key/turntable/000000.exr"));
  EXPECT_THAT(warnings.texts, Contains(HasSubstr("no film")));
}

// The take twice, one of them to the side; then with what is not there or not known.
TEST_F(LookFilm, OfASceneShowsItsPerformancesAndNamesWhatIsGone) {
  SceneDocument scene;
  scene.look = sunny("");
  Performance one;
  one.project = referenceTo(solved().folder(), folder_.path());
  Performance other = one;
  other.scene_from_performance.translation = {0.6, 0, 0};
  scene.performances = {one, other};
  std::ofstream(folder_ / "two.json") << toJson(scene);
  RenderLookRequest request = asked(sunny("one"));
  request.frames = "0";
  render(request);
  request.look = chosenLook(solved(), (folder_ / "two.json").string());
  EXPECT_EQ(render(request).folder, "look_two");
  const auto covered = [&](const char* file) {
    const auto alpha = readAlpha(folder_ / file);
    return std::count_if(alpha.pixels.begin(), alpha.pixels.end(), [](std::uint8_t a) { return a > 127; });
  };
  EXPECT_GT(covered("out/look_two/cam0/000000.png"),
            1.3 * static_cast<double>(covered("out/look_one/cam0/000000.png")));
  RenderLookRequest empty = request;
  empty.look.scene->performances.clear();
  EXPECT_THAT(messageOf(Error::Kind::Data, [&] { render(empty); }), HasSubstr("the scene is empty"));
  request.look.scene->meshes.push_back({.file = {"gone.ply", ""}});
  EXPECT_THAT(messageOf(Error::Kind::Data, [&] { render(request); }), HasSubstr("gone.ply"));
  request.look.scene->meshes.clear();
  request.look.scene->ground.unknown = R"({"colour": 3})";
  request.force = true;
  const Warnings warnings;
  render(request);
  EXPECT_THAT(warnings.texts, Contains(HasSubstr("ground.colour")));
}

}  // namespace
}  // namespace beam::testing
