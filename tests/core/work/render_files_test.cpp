// SPDX-License-Identifier: Apache-2.0
// Files of pictures: layers hold what the files of single channels hold, and what is there already is made
// from what it would be made from again, or is made anew.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <stop_token>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/io/file_notes.h"
#include "core/io/image_file.h"
#include "core/math/color.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/stages/picture_files.h"
#include "core/work/render_frames.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_project.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr StandInSize kSmall{.cameras = 3, .frames = 2, .size_px = 48};

// Draws as another does and stops the work after so many draws.
class StoppingRenderer final : public SceneRenderer {
 public:
  StoppingRenderer(std::unique_ptr<SceneRenderer> inner, std::stop_source& stop, int draws)
      : inner_(std::move(inner)), stop_(stop), left_(draws) {}
  const RendererAbilities& abilities() const override { return inner_->abilities(); }

 private:
  void doLoad(const RenderScene& scene, const Progress& progress) override { inner_->load(scene, progress); }
  void doDraw(const Camera& camera, std::span<const ChannelInfo> channels, Progress& progress,
              const OnPicture& on_picture) override {
    inner_->draw(camera, channels, progress, on_picture);
    if (--left_ == 0) stop_.request_stop();
  }
  std::unique_ptr<SceneRenderer> inner_;
  std::stop_source& stop_;
  int left_;
};

class RenderFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    Planes sky(8, 4, 3);
    for (std::size_t i = 0; i < sky.values.size(); ++i)
      sky.values[i] = 0.1f + 0.05f * static_cast<float>(i % 7);
    writeExr(folder_ / "sky.v2.exr", sky, {"R", "G", "B"}, ExrPrecision::Float);
  }
  static const Project& solved() {
    static const TempDir folder;
    static const Project project = solvedStandIn(folder.path(), kSmall);
    return project;
  }
  RenderFramesRequest all(const fs::path& out) const {
    return {
        .project = solved(),
        .channels = {"rgb", "relight", "base_color", "ao", "roughness", "normal", "depth", "alpha", "mesh"},
        .cameras = "cam0,cam2",
        .frames = "all",
        .environments = {folder_ / "sky.v2.exr"},
        .out = out};
  }
  RenderFramesOutcome render(const RenderFramesRequest& request) const {
    Progress progress;
    return renderFrames(request, *newCpuSceneRenderer(*device_), progress);
  }
  // Every file of a folder with its bytes, by its path in it.
  static std::map<std::string, std::string> filesIn(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file())
        files[entry.path().lexically_relative(folder).generic_string()] = readTextFile(entry.path());
    }
    return files;
  }
  // Files that a request with skip_existing makes anew.
  std::size_t madeAnew(RenderFramesRequest request) const {
    request.skip_existing = true;
    return render(request).written;
  }

  TempDir folder_;
  std::unique_ptr<ComputeDevice> device_ = makeCpuDevice();
};

// Two panoramas of one file name would share a folder.
TEST_F(RenderFiles, OfAnotherPanoramaOfTheSameNameDoNotJoinThose) {
  for (const bool layers : {false, true}) {
    RenderFramesRequest request = all(folder_ / (layers ? "layered" : "single"));
    request.channels = {"relight"};
    request.layers = layers;
    request.frames = "0";
    render(request);
    fs::create_directories(folder_ / "other");
    writeExr(folder_ / "other/sky.v2.exr", Planes(8, 4, 3, 0.3f), {"R", "G", "B"}, ExrPrecision::Float);
    const fs::path first = request.environments[0];
    request.environments = {folder_ / "other/sky.v2.exr"};
    EXPECT_EQ(render(request).written, 2u) << "all of them anew";
    request.environments = {first};
    request.frames = "1";
    const std::string said = messageOf(Error::Kind::Usage, [&] { render(request); });
    EXPECT_THAT(said, ::testing::AllOf(HasSubstr("lit by another panorama"), HasSubstr("--force")));
    request.environments = {folder_ / "other/sky.v2.exr"};
    EXPECT_EQ(render(request).written, 2u);
    request.environments = {first};
    request.frames = "0";
    request.force = true;
    EXPECT_EQ(render(request).written, 2u);
  }
}

TEST_F(RenderFiles, LayersHoldWhatTheSingleFilesHold) {
  RenderFramesRequest request = all(folder_ / "single");
  render(request);
  request.layers = true;
  request.out = folder_ / "layered";
  EXPECT_EQ(render(request).written, 2u * 2 + 2);
  for (const char* camera : {"cam0", "cam2"}) {
    const std::string frame = fmt::format("{}/000001", camera);
    const fs::path layered = folder_ / "layered/layers" / (frame + ".exr");
    const auto single = [&](const char* channel, const char* extension) {
      return folder_ / "single" / channel / (frame + extension);
    };
    EXPECT_EQ(readExr(layered, {"base_color.R", "base_color.G", "base_color.B"}).values,
              readExr(single("base_color", ".exr"), {"R", "G", "B"}).values);
    EXPECT_EQ(readExr(layered, {"normal.X", "normal.Y", "normal.Z"}).values,
              readExr(single("normal", ".exr"), {"R", "G", "B"}).values);
    for (const char* one : {"ao", "roughness"})
      EXPECT_EQ(readExr(layered, {std::string(one) + ".Y"}).values,
                readExr(single(one, ".exr"), {"Y"}).values);
    EXPECT_EQ(readExr(layered, {"depth.Z"}).values, readExr(single("depth", ".exr"), {"Y"}).values);
    EXPECT_EQ(readExr(layered, {"A"}).values, readExr(layered, {"alpha.A"}).values);
    const auto expectPicture = [&](const std::vector<std::string>& names, const fs::path& png) {
      const Planes p = readExr(layered, names);
      const Image<u8vec3> picture = readPhoto(png);
      for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(byteOf(srgbFromLinear(p.plane(c)[i])), picture.pixels[i][c], 1) << png << " " << i;
      }
    };
    expectPicture({"R", "G", "B"}, single("rgb", ".png"));
    expectPicture({"relight_sky_v2.R", "relight_sky_v2.G", "relight_sky_v2.B"},
                  single("relight_sky.v2", ".png"));
    const Planes alpha = readExr(layered, {"A"});
    const Image<u8vec3> coverage = readPhoto(single("alpha", ".png"));
    for (std::size_t i = 0; i < coverage.pixels.size(); ++i)
      ASSERT_NEAR(byteOf(alpha.values[i]), coverage.pixels[i].x, 1);
  }
  EXPECT_EQ(readTextFile(folder_ / "layered/mesh/000000.ply"),
            readTextFile(folder_ / "single/mesh/000000.ply"));
}

TEST_F(RenderFiles, LayersAreThoseThatWereAskedForAndColourHasItsCoverage) {
  RenderFramesRequest request = all(folder_ / "out");
  request.layers = true;
  const fs::path file = folder_ / "out/layers/cam0/000000.exr";
  request.channels = {"rgb", "depth"};
  render(request);
  EXPECT_THAT(exrChannels(file), ElementsAre("A", "B", "G", "R", "depth.Z"));
  const FileNotes notes = notesIn(file);
  EXPECT_EQ(noteIn(notes, "Software"), "BEAM Studio, beam render");
  EXPECT_EQ(noteIn(notes, "layers"), "rgb, depth");
  EXPECT_EQ(noteIn(notes, "color_state"), "scene-linear Rec.709");
  EXPECT_THAT(noteIn(notes, "rgb_encoding"), HasSubstr("decoded from sRGB"));
  EXPECT_EQ(noteIn(notes, "unit"), "m");
  request.channels = {"alpha", "ao"};
  render(request);
  EXPECT_THAT(exrChannels(file), ElementsAre("alpha.A", "ao.Y"));
  request.channels = {"mesh"};
  request.out = folder_ / "meshes";
  EXPECT_EQ(render(request).written, 2u);
  EXPECT_FALSE(fs::exists(folder_ / "meshes/layers"));
}

TEST_F(RenderFiles, LayersGoOverNobodysFileAndHaveOneNameEach) {
  RenderFramesRequest request = all(folder_ / "out");
  request.layers = true;
  const fs::path file = folder_ / "out/layers/cam2/000001.exr";
  fs::create_directories(file.parent_path());
  std::ofstream(file) << "my own words";
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { render(request); }), HasSubstr("000001.exr"));
  EXPECT_EQ(filesIn(folder_ / "out").size(), 1u);
  request.out = folder_ / "twice";
  request.channels = {"depth", "depth"};
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { render(request); }), HasSubstr("depth.Z"));
  request.channels = {"relight"};
  request.environments.push_back(folder_ / "sky_v2.exr");
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { render(request); }), HasSubstr("relight_sky_v2.R"));
}

TEST_F(RenderFiles, LayersOfTooLargePicturesAreRefusedBeforeTheWork) {
  std::vector<DrawnChannel> drawn;
  for (const char* id : {"rgb", "base_color", "normal", "depth"})
    drawn.push_back({channelOf(id), id, nullptr});
  EXPECT_NO_THROW(requireLayers("x.exr", drawn, 4096, 4096));
  EXPECT_THAT(dataErrorOf([&] { requireLayers("x.exr", drawn, 16384, 16384); }),
              AllOf(HasSubstr("x.exr"), HasSubstr("fewer channels")));
}

TEST_F(RenderFiles, WhatIsThereIsNotMadeAgain) {
  for (const bool layers : {false, true}) {
    RenderFramesRequest request = all(folder_ / (layers ? "layered" : "single"));
    request.layers = layers;
    const std::size_t files = layers ? 2u * 2 + 2 : 2u * 2 * 8 + 2;
    const RenderFramesOutcome first = render(request);
    EXPECT_EQ(first.written, files);
    EXPECT_EQ(first.kept, 0u);
    const auto before = filesIn(request.out);
    EXPECT_EQ(before.size(), files);
    request.skip_existing = true;
    const RenderFramesOutcome again = render(request);
    EXPECT_EQ(again.written, 0u);
    EXPECT_EQ(again.kept, files);
    request.skip_existing = false;
    EXPECT_EQ(render(request).written, files) << "all anew without the word";
    EXPECT_EQ(filesIn(request.out), before);
  }
}

TEST_F(RenderFiles, WhatIsGoneDamagedOrAnothersIsMadeAgainAndTheRestIsLeft) {
  RenderFramesRequest request = all(folder_ / "out");
  render(request);
  const auto before = filesIn(request.out);
  const std::vector<std::string> spoilt = {"rgb/cam0/000000.png", "depth/cam2/000001.exr", "mesh/000001.ply"};
  for (const std::string& file : spoilt)
    std::ofstream(request.out / file, std::ios::binary)
        << before.at(file).substr(0, before.at(file).size() - 3);
  fs::remove(request.out / "relight_sky.v2/cam0/000001.png");
  EXPECT_EQ(madeAnew(request), spoilt.size() + 1);
  EXPECT_EQ(filesIn(request.out), before);
  writePng(request.out / "rgb/cam0/000000.png", Image<u8vec3>(4, 4), {{"Software", "another program"}});
  request.force = true;
  EXPECT_EQ(madeAnew(request), 1u);
  EXPECT_EQ(filesIn(request.out), before);
}

TEST_F(RenderFiles, WhatAnotherLightOrOtherAxesWouldGiveIsMadeAgain) {
  RenderFramesRequest request = all(folder_ / "out");
  request.channels = {"rgb", "relight", "normal", "mesh"};
  render(request);
  EXPECT_EQ(madeAnew(request), 0u);
  Planes sky(8, 4, 3, 0.25f);
  writeExr(folder_ / "sky.v2.exr", sky, {"R", "G", "B"}, ExrPrecision::Float);
  EXPECT_EQ(madeAnew(request), 2u * 2) << "the relit pictures alone";
  fs::create_directories(folder_ / "elsewhere");
  fs::rename(folder_ / "sky.v2.exr", folder_ / "elsewhere/sky.v2.exr");
  request.environments = {folder_ / "elsewhere/sky.v2.exr"};
  EXPECT_EQ(madeAnew(request), 0u) << "the same light, from another place";
  request.world_frame = true;
  EXPECT_EQ(madeAnew(request), 2u * 2 * 3 + 2);
  request.layers = true;
  EXPECT_EQ(madeAnew(request), 2u * 2);
  request.channels = {"rgb", "normal"};
  EXPECT_EQ(madeAnew(request), 2u * 2) << "of other layers";
}

TEST_F(RenderFiles, OfOtherResultsOrCamerasIsMadeAgain) {
  Project project = solvedStandIn(folder_ / "p", kSmall);
  RenderFramesRequest request = all(folder_ / "out");
  request.channels = {"rgb", "depth"};
  request.project = project;
  render(request);
  project.set("surface.iterations", 200);
  project.save();
  request.project = solvedAgain(project, kSmall);
  EXPECT_EQ(madeAnew(request), 2u * 2 * 2);
  EXPECT_EQ(madeAnew(request), 0u);
  request.project = solvedStandIn(folder_ / "q", {.cameras = 3, .frames = 2, .size_px = 64});
  EXPECT_EQ(madeAnew(request), 2u * 2 * 2) << "pictures of another size";
}

TEST_F(RenderFiles, OfTwoProjectsMadeAlikeAreTheSameBytes) {
  RenderFramesRequest request = all(folder_ / "a");
  render(request);
  request.project = solvedStandIn(folder_ / "elsewhere", kSmall);
  request.out = folder_ / "b";
  render(request);
  EXPECT_EQ(filesIn(folder_ / "a"), filesIn(folder_ / "b"));
  request.out = folder_ / "a";
  EXPECT_EQ(madeAnew(request), 0u);
}

TEST_F(RenderFiles, AnInterruptedRenderGoesOn) {
  RenderFramesRequest request = all(folder_ / "whole");
  render(request);
  request.out = folder_ / "cut";
  std::stop_source stop;
  StoppingRenderer renderer(newCpuSceneRenderer(*device_), stop, 3);
  Progress progress(stop.get_token());
  EXPECT_THROW(renderFrames(request, renderer, progress), Cancelled);
  const std::size_t there = filesIn(request.out).size();
  EXPECT_GT(there, 0u);
  EXPECT_EQ(madeAnew(request), filesIn(folder_ / "whole").size() - there);
  EXPECT_EQ(filesIn(request.out), filesIn(folder_ / "whole"));
}

TEST_F(RenderFiles, TwoPanoramasOfOneNameAreRefusedAndBothNamed) {
  RenderFramesRequest request = all(folder_ / "out");
  request.environments = {folder_ / "a/x.exr", folder_ / "b/x.exr"};
  const std::string said = messageOf(Error::Kind::Usage, [&] { render(request); });
  EXPECT_THAT(said, AllOf(HasSubstr((folder_ / "a/x.exr").string()),
                          HasSubstr((folder_ / "b/x.exr").string()), HasSubstr("relight_x")));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace beam::testing
