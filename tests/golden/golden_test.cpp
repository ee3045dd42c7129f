// SPDX-License-Identifier: Apache-2.0
// The last word after all laws: the pictures of a small sample, from photographs to light of another place,
// look as they did. A change that moves them on purpose stores new ones: BEAM_UPDATE_GOLDEN=1 writes them
// into tests/golden and fails, so that it never passes for a test; the commit says why they moved.
#include <gtest/gtest.h>

#include <cmath>

#include "core/io/image_file.h"
#include "core/math/color.h"
#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;

// Threads and instruction sets give the same bits: what is allowed for is another libm or compiler.
constexpr double kMostMean = 0.5;  // of 255, over all pixels and channels
constexpr int kMostAnywhere = 4;
constexpr const char* kCamera = "test00";

// A held-out camera's pictures of a fitted sample. The numbers are not meant to be good: few steps and few
// Gaussians, well seen, so that the last bit of a foreign exp() does not grow into another picture.
class Rendered {
 public:
  static const fs::path& pictures() {
    static const Rendered rendered;
    return rendered.pictures_;
  }

 private:
  Rendered() : pictures_(folder_ / "pictures") {
    const std::string capture = (folder_ / "sample").string(), project = (folder_ / "p.beam").string();
    beam({"sample", capture, "--cameras", "12", "--size", "96x128", "--samples", "16"});
    beam({"process", capture, "--out", project, "--preset", "draft", "--set", "surface.iterations=60",
          "--set", "surface.cap=1500", "--set", "surface.seed_share=0.9", "--set",
          "surface.mesh.voxel_m=0.02", "--set", "materials.ao_samples=64", "--set",
          "materials.base_color_samples=100"});
    beam({"render", project, "--channels", "rgb,relight,base_color,ao,normal,alpha", "--environment",
          capture + "/gt/environments/studio.exr", "--cameras", kCamera, "--frames", "all", "--out",
          pictures_.string()});
    const fs::path ao = folder_ / "ao";
    beam({"render", project, "--channels", "relight", "--set", "relight.environment_shadows=ao",
          "--environment", capture + "/gt/environments/studio.exr", "--cameras", kCamera, "--out",
          ao.string()});
    fs::rename(ao / "relight_studio", pictures_ / "relight_ao");
  }
  void beam(const Words& words) const {
    const Said said = Running(folder_.path(), words).wait();
    if (said.code != 0) throw std::runtime_error("beam " + words[0] + ": " + said.err);
  }
  TempDir folder_;
  fs::path pictures_;
};

fs::path rendered(const std::string& channel, const char* extension) {
  return Rendered::pictures() / channel / kCamera / (std::string("000000") + extension);
}

// Values of an EXR picture as bytes, `encode` a pixel.
template <class Encode>
Image<u8vec3> encoded(const std::string& channel, const std::vector<std::string>& names, Encode&& encode) {
  const Planes p = readExr(rendered(channel, ".exr"), names);
  Image<u8vec3> out(p.width, p.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    const auto value = [&](int c) { return p.plane(std::min(c, p.channels - 1))[i]; };
    const vec3 v = encode(vec3(value(0), value(1), value(2)), i);
    out.pixels[i] = u8vec3(byteOf(v.x), byteOf(v.y), byteOf(v.z));
  }
  return out;
}

Image<u8vec3> pictureOf(const std::string& channel) {
  if (channel == "base_color") {
    return encoded(channel, {"R", "G", "B"}, [](vec3 v, std::size_t) { return srgbFromLinear(v); });
  }
  if (channel == "ao") return encoded(channel, {"Y"}, [](vec3 v, std::size_t) { return v; });
  if (channel != "normal") return readPhoto(rendered(channel, ".png"));
  // By coverage, like the others: without it the silhouette would jump.
  const Image<u8vec3> alpha = readPhoto(rendered("alpha", ".png"));
  return encoded(channel, {"R", "G", "B"}, [&](vec3 v, std::size_t i) {
    return (0.5f * v + 0.5f) * (static_cast<float>(alpha.pixels[i].x) / 255);
  });
}

class Golden : public ::testing::TestWithParam<const char*> {};

TEST_P(Golden, LooksAsItDid) {
  const Image<u8vec3> found = pictureOf(GetParam());
  const fs::path stored = fs::path(BEAM_SOURCE_DIR) / "tests/golden" / (std::string(GetParam()) + ".png");
  if (std::getenv("BEAM_UPDATE_GOLDEN")) {
    writePng(stored, found);
    FAIL() << "wrote " << stored << "; look at it, and run again without BEAM_UPDATE_GOLDEN";
  }
  const Image<u8vec3> expected = readPhoto(stored);
  ASSERT_EQ(ivec2(found.width, found.height), ivec2(expected.width, expected.height));
  double sum = 0;
  int worst = 0;
  for (std::size_t i = 0; i < found.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const int off = std::abs(int{found.pixels[i][c]} - int{expected.pixels[i][c]});
      sum += off;
      worst = std::max(worst, off);
    }
  }
  const double mean = sum / (3.0 * static_cast<double>(found.pixels.size()));
  EXPECT_LE(mean, kMostMean);
  EXPECT_LE(worst, kMostAnywhere);
  RecordProperty("worst", worst);
  RecordProperty("mean", std::to_string(mean));
}

INSTANTIATE_TEST_SUITE_P(Pictures, Golden,
                         ::testing::Values("rgb", "relight_studio", "relight_ao", "base_color", "ao",
                                           "normal"),
                         [](const auto& p) { return std::string(p.param); });

}  // namespace
}  // namespace beam::testing
