// SPDX-License-Identifier: Apache-2.0
// The program `beam-studio` as it is installed: it starts on what `beam` made, takes its picture, says what
// is wrong and ends when it is told to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/io/image_file.h"
#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr int kScreenWidth = 1600, kScreenHeight = 1000;  // of the display that beam_add_test gives

// A value of the environment for as long as this lives; empty: not set.
class Environ {
 public:
  Environ(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~Environ() { set(before_); }
  Environ(const Environ&) = delete;
  Environ& operator=(const Environ&) = delete;

 private:
  void set(const std::string& value) const {
    value.empty() ? ::unsetenv(name_) : ::setenv(name_, value.c_str(), 1);
  }
  const char* name_;
  std::string before_;
};

class StudioProgram : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = new TempDir;
    const Said said =
        Running(made_->path(),
                Words{"process", SampleHouse::capture().string(), "--out", project().string()} + tiny())
            .wait();
    ASSERT_EQ(said.code, 0) << said.err;
  }
  static void TearDownTestSuite() { delete made_; }
  static fs::path project() { return made_->path() / "solved.beam"; }

  fs::path at(const char* name) const { return folder_.path() / name; }
  // Nothing of this person's machine is seen or changed.
  Running start(const Words& words) const {
    const Environ home("HOME", folder_.path().string()), config("XDG_CONFIG_HOME", at("config").string()),
        data("XDG_DATA_HOME", at("data").string()), cache("XDG_CACHE_HOME", at("cache").string()),
        map("BEAM_STUDIO_MAP", at("map.json").string());
    return {folder_.path(), words, RLIM_INFINITY, BEAM_STUDIO_PROGRAM};
  }
  Said studio(const Words& words) const { return start(words).wait(); }

  // A picture of the window, which the program is to take and end well.
  Image<u8vec3> pictureOf(const Words& words) const {
    fs::remove(at("window.png"));
    const Said said = studio(words + Words{"--screenshot", at("window.png").string()});
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_THAT(said.err, Not(HasSubstr("error:")));
    return readPhoto(at("window.png"));
  }
  void expectUsage(const Words& words, const std::string& hint) const {
    const Said said = studio(words);
    EXPECT_EQ(said.code, 2) << said.err;
    EXPECT_THAT(said.err, AllOf(HasSubstr("error: "), HasSubstr(hint)));
  }
  // Whether it came about while the program was running; patience ends a test that hangs.
  template <class Condition>
  static bool comes(const Running& run, Condition&& condition) {
    for (int i = 0; i < 12000 && !run.ended(); ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  bool windowSays(const Running& run, const std::string& words) const {
    return comes(run, [&] { return textOf(at("map.json")).find(words) != std::string::npos; });
  }

  TempDir folder_;

 private:
  static inline TempDir* made_ = nullptr;
};

double shareOfDifferentPixels(const Image<u8vec3>& a, const Image<u8vec3>& b) {
  EXPECT_EQ(ivec2(a.width, a.height), ivec2(b.width, b.height));
  double different = 0;
  for (std::size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i)
    different += a.pixels[i] != b.pixels[i];
  return different / static_cast<double>(a.pixels.size());
}

std::size_t colorsOf(const Image<u8vec3>& image) {
  std::set<int> colors;
  for (const u8vec3& p : image.pixels) colors.insert((p.x << 16) | (p.y << 8) | p.z);
  return colors.size();
}

TEST_F(StudioProgram, HelpAndVersionAnswerWithoutADisplay) {
  const Environ display("DISPLAY", ""), wayland("WAYLAND_DISPLAY", "");
  const Said help = studio({"--help"}), version = studio({"--version"});
  EXPECT_EQ(help.code, 0) << help.err;
  EXPECT_THAT(help.out, AllOf(HasSubstr("--screenshot"), HasSubstr("P.beam")));
  EXPECT_EQ(version.code, 0) << version.err;
  EXPECT_THAT(version.out, StartsWith("beam-studio 0."));
  const Said rest = studio({project().string(), "--screenshot", at("window.png").string()});
  EXPECT_EQ(rest.code, 69) << rest.err;
  EXPECT_THAT(rest.err, HasSubstr("error: "));
}

TEST_F(StudioProgram, TakesAPictureOfAProjectAndChangesNothingInIt) {
  const auto before = filesIn(project());
  const Image<u8vec3> nothing = pictureOf({}), lit = pictureOf({project().string()});
  EXPECT_TRUE(filesIn(project()) == before);
  for (const Image<u8vec3>& picture : {nothing, lit}) {
    // All of the screen but the frame that a desktop draws.
    EXPECT_LE(picture.width, kScreenWidth);
    EXPECT_LE(picture.height, kScreenHeight);
    EXPECT_GE(picture.width, kScreenWidth - 50);
    EXPECT_GE(picture.height, kScreenHeight - 50);
  }
  EXPECT_GT(colorsOf(lit), colorsOf(nothing) + 300) << "the performer has colours";
  EXPECT_GT(shareOfDifferentPixels(lit, nothing), 0.1);
}

TEST_F(StudioProgram, TheWordsOfItsCommandLineAreSeenInThePicture) {
  const Image<u8vec3> lit = pictureOf({project().string()});
  for (const Words& words : {Words{"--channel", "normal"}, Words{"--view", "image"}, Words{"--view", "scene"},
                             Words{"--camera", "test00"}}) {
    EXPECT_GT(shareOfDifferentPixels(pictureOf(Words{project().string()} + words), lit), 0.01)
        << words[0] << " " << words[1];
  }
}

TEST_F(StudioProgram, WrongWordsAreUsageErrorsAndLeaveNoPicture) {
  const Words picture = {project().string(), "--screenshot", at("window.png").string()};
  expectUsage(picture + Words{"--view", "plan"}, "plan");
  expectUsage(picture + Words{"--channel", "colour"}, "colour");
  expectUsage(picture + Words{"--yaw", "left"}, "--yaw");
  expectUsage(picture + Words{"--frame", "000099"}, "000099");
  EXPECT_FALSE(fs::exists(at("window.png")));
  expectUsage({project().string(), "--screenshot", at("nowhere/window.png").string()}, "nowhere");
}

TEST_F(StudioProgram, ABrokenProjectIsSaidInTheWindowWithItsFile) {
  fs::create_directories(at("broken.beam"));
  std::ofstream(at("broken.beam") / "project.json") << "{ \"capture\": ";
  const Running run = start({at("broken.beam").string()});
  EXPECT_TRUE(windowSays(run, "Cannot open broken.beam"));
  EXPECT_TRUE(windowSays(run, "project.json"));
  run.signal(SIGTERM);
  run.wait();
  EXPECT_EQ(filesIn(at("broken.beam")).size(), 1u) << "it is left as it was";
}

TEST_F(StudioProgram, ATerminationDuringARunEndsItAndCostsNothingThatWasFinished) {
  const Words slow = {"--set", "surface.iterations=100000"};
  const Said made = Running(folder_.path(), Words{"process", SampleHouse::capture().string(), "--out",
                                                  at("p.beam").string(), "--until", "capture"} +
                                                tiny() + slow)
                        .wait();
  ASSERT_EQ(made.code, 0) << made.err;
  const int before = publishedIn(at("p.beam"));
  const Running run = start({at("p.beam").string(), "--run", "--until", "surface"});
  // More was published, and the next step is at work.
  ASSERT_TRUE(comes(run, [&] {
    return publishedIn(at("p.beam")) > before && fs::exists(at("p.beam") / "leases") &&
           !fs::is_empty(at("p.beam") / "leases");
  }));
  run.signal(SIGTERM);
  EXPECT_FALSE(comes(run, [] { return false; }));
  ASSERT_TRUE(run.ended());
  EXPECT_THAT(run.wait().code, AnyOf(Eq(0), Eq(75), Eq(-SIGTERM)));
  const Said rest = Running(folder_.path(), {"run", at("p.beam").string(), "--until", "surface", "--frames",
                                             "0", "--set", "surface.iterations=20", "--verbose"})
                        .wait();
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_THAT(rest.err,
              AllOf(HasSubstr("capture.import: reused"), HasSubstr("surface.mesh, frame 000000 done")));
}

}  // namespace
}  // namespace beam::testing
